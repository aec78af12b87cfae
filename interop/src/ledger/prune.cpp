// SPDX-License-Identifier: MIT
// Forgetting signals. Two neighbouring signals of a timeline may become one when nobody can ever tell which of them a
// wait has met: when every access (or other mark) that the ledger still remembers lies on the same side of both. New
// marks get ticks above all that was published, so they cannot fall between the two later on.
#include <algorithm>

#include "state.hpp"

namespace sluice::ledger {
namespace {

/// Ticks that are still remembered, by actor, ascending.
using Marks = std::vector<std::vector<std::uint64_t>>;

void mark(Marks& marks, Epoch epoch) {
    if (epoch.tick != 0) {
        marks[epoch.actor].push_back(epoch.tick);
    }
}

bool between(const Marks& marks, const Clock& low, const Clock& high) {
    for (Slot i = 0; i < marks.size(); ++i) {
        const auto next = std::upper_bound(marks[i].begin(), marks[i].end(), low.get(i));
        if (next != marks[i].end() && *next <= high.get(i)) {
            return true;
        }
    }
    return false;
}

using Listed = std::vector<std::pair<Slot, Clock>>;

bool differ(const Marks& marks, const Listed& low, const Listed& high) {
    static const Clock kNothing;
    return std::any_of(high.begin(), high.end(), [&](const auto& one) {
        const auto same =
            std::find_if(low.begin(), low.end(), [&](const auto& other) { return other.first == one.first; });
        return between(marks, same == low.end() ? kNothing : same->second, one.second);
    });
}

bool alike(const Marks& marks, const Entry& low, const Entry& high) {
    static const Listed kNone;
    const Sight* low_sight = low.know.sight();
    const Sight* high_sight = high.know.sight();
    return !between(marks, low.know.order(), high.know.order()) &&
           !between(marks, low.know.visible(), high.know.visible()) &&
           !between(marks, low.everything, high.everything) && !differ(marks, low.named, high.named) &&
           !differ(marks, low_sight != nullptr ? low_sight->listed : kNone,
                   high_sight != nullptr ? high_sight->listed : kNone);
}

}  // namespace

void Ledger::State::prune(Sync& sync) {
    Marks marks(actors.size());
    for (const Resource& resource : resources) {
        mark(marks, resource.write_at);
        for (const ReadMark& read : resource.reads) {
            mark(marks, read.at);
        }
        if (resource.behind) {
            mark(marks, resource.behind->until);
            mark(marks, resource.behind->last);
        }
        for (const Forgiven& one : resource.forgiven) {
            mark(marks, one.before);
            mark(marks, one.after);
        }
    }
    for (const OpenRace& one : open_races) {
        mark(marks, one.at);
    }
    for (const Sync& one : syncs) {
        mark(marks, one.consumed_at);
        for (const SyncUse& use : one.uses) {
            mark(marks, use.at);
        }
    }
    for (auto& ticks : marks) {
        std::sort(ticks.begin(), ticks.end());
    }
    auto& entries = sync.entries;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (i + 1 < entries.size() && alike(marks, entries[i], entries[i + 1])) {
            continue;  // waits for it meet the next one
        }
        if (kept != i) {
            entries[kept] = std::move(entries[i]);
        }
        ++kept;
    }
    entries.resize(kept);
    // Looking costs as much as there are objects and signals: wait for as many new signals.
    sync.prune_at = std::max(2 * kept, (resources.size() + syncs.size()) / 4);
}

}  // namespace sluice::ledger
