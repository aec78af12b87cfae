// SPDX-License-Identifier: MIT
// Two accesses without order: which of them should have waited for the other, and for what. A log may show the two
// either way round (a queue tells late of what it did), so its order says nothing about that; versions, frames and the
// hand-over of ownership do.
#include <algorithm>

#include <fmt/format.h>

#include "state.hpp"

namespace sluice::ledger {
namespace {

// A race whose edge nobody's signal has named by then keeps the name that it has.
constexpr std::size_t kMostOpenRaces = 32;

bool isContent(const Event& event) {
    return event.value != 0 && (event.kind == EventKind::Read || event.kind == EventKind::Write);
}

/// Whether `second`, which stands later in the log, is what `first` should have waited for.
bool reversed(const Resource& resource, const Actor& by, const Event& first, const Event& second) {
    if (isContent(first) && isContent(second) && first.value != second.value) {
        return second.value < first.value;
    }
    if (isContent(first) && isContent(second)) {
        return first.kind == EventKind::Read;  // a reader of that version comes after its writer
    }
    if (first.frame != 0 && second.frame != 0 && first.frame != second.frame) {
        return second.frame < first.frame;
    }
    // `first` took back what it had released to `second`, before `second` has had it.
    return resource.retaken && resource.retaken->event.actor == first.actor &&
           (by.after(resource.retaken->at) || (second.frame != 0 && second.frame == resource.retaken->event.frame));
}

FindingKind turned(FindingKind kind) {
    return kind == FindingKind::ReadAfterWrite   ? FindingKind::WriteAfterRead
           : kind == FindingKind::WriteAfterRead ? FindingKind::ReadAfterWrite
                                                 : kind;
}

}  // namespace

void Ledger::State::race(FindingKind kind, Actor& by, Resource& resource, Epoch at, const Event& first,
                         const Event& second) {
    const auto known_order = [&](const Forgiven& one) {
        return one.before.actor == at.actor && at.tick <= one.before.tick && by.after(one.after);
    };
    if (std::any_of(resource.forgiven.begin(), resource.forgiven.end(), known_order)) {
        return;
    }
    const bool turn = reversed(resource, by, first, second);
    OpenRace one{findings.size(), resource.id, resource.name, at, first, second, by.slot, false};
    if (turn) {
        std::swap(one.early, one.late);
        one.at = by.now();
        one.waiting = at.actor;
        one.release_to_come = second.kind == EventKind::Acquire;
    }
    if (report(turn ? turned(kind) : kind, resource.id, one.early, one.late) != nullptr) {
        const EdgeText missing = missingEdge(one.at, one.early, actors[one.waiting], one.late, resource.name);
        tellRace(one, missing);
        if (!missing.certain || one.release_to_come) {
            if (open_races.size() >= kMostOpenRaces) {
                open_races.erase(open_races.begin());
            }
            open_races.push_back(one);
        }
    }
    by.raced_in = second.frame;
    actors[at.actor].raced_in = first.frame;
    // From here on the two are taken to be ordered, and what hangs on the state that they left to chance is not judged.
    const auto same = std::find_if(resource.forgiven.begin(), resource.forgiven.end(), [&](const Forgiven& other) {
        return other.before.actor == at.actor && other.after.actor == by.slot;
    });
    (same == resource.forgiven.end() ? resource.forgiven.emplace_back() : *same) = Forgiven{at, by.now()};
    if (turn && first.kind != EventKind::Read) {
        resource.behind = Behind{by.slot, at, by.now(), second};  // the state that `first` has left is the newer one
        return;
    }
    resource.owner = kNoActor;
    resource.release.reset();
    resource.retaken.reset();
    resource.layout = 0;
}

void Ledger::State::tellRace(const OpenRace& one, const EdgeText& missing) {
    Finding& found = findings[one.finding];
    const std::string early = name(one.early.actor);
    const std::string late = name(one.late.actor);
    const std::string& what = one.name;
    const std::string version = isContent(one.late) ? fmt::format(" (version {})", one.late.value) : std::string();
    found.first = one.early;
    found.edge = missing.edge;
    found.sentence =
        fmt::format("{} {} {} in frame {}{}, but nothing orders that after the {} by {} in frame {}.", late,
                    verb(one.late.kind), what, one.late.frame, version, accessText(one.early), early, one.early.frame);
    if (missing.certain) {
        found.remedy =
            fmt::format("Let {} wait for {} before the {} of {} by {}; {} signals that after the {}{}.", missing.waiter,
                        missing.awaited, toString(one.late.kind), one.name, late, missing.signaller,
                        toString(one.early.kind), missing.signaller == early ? "" : " by " + early);
    } else {
        found.remedy =
            fmt::format("Let {} signal after its {} of {}, and let {} wait for that before its {} (missing: {}).",
                        early, toString(one.early.kind), one.name, late, toString(one.late.kind), found.edge);
    }
}

void Ledger::State::releasedLate(const Actor& by, const Resource& resource, const Event& event) {
    for (OpenRace& one : open_races) {
        if (one.release_to_come && one.early.actor == by.id && one.resource == resource.id) {
            one.early = event;
            one.at = by.now();
            one.release_to_come = false;
            tellRace(one, missingEdge(one.at, one.early, actors[one.waiting], one.late, one.name));
        }
    }
}

const Actor* Ledger::State::waiterFor(const Sync& sync, const Actor& late) const {
    const Actor* feeder = nullptr;
    for (const SyncUse& use : sync.uses) {
        if (!use.waited) {
            continue;
        }
        if (use.at.actor == late.slot) {
            return &late;
        }
        const bool feeds = std::find(late.fed_by.begin(), late.fed_by.end(), use.at.actor) != late.fed_by.end();
        feeder = feeds ? &actors[use.at.actor] : feeder;
    }
    return feeder;
}

EdgeText Ledger::State::missingEdge(Epoch at, const Event& first, const Actor& late, const Event& second,
                                    const std::string& what) const {
    // Best named by a signal that comes after the first event and that the second's actor waits for elsewhere, be it
    // given by somebody who had waited for the first (a bridge); else by one that the first's actor gave itself.
    const Entry* best = nullptr;
    const Sync* best_sync = nullptr;
    const Actor* best_waiter = nullptr;
    int best_rank = -1;
    for (const Sync& sync : syncs) {
        const Actor* waiter = waiterFor(sync, late);
        for (const Entry& entry : sync.entries) {
            if (!entry.know.order().covers(at)) {
                continue;
            }
            const int own = entry.by.actor == at.actor ? 1 : 0;
            const int rank = waiter == nullptr ? own - 1 : own + (waiter == &late ? 4 : 2);
            if (rank > best_rank) {
                best_rank = rank;
                best = &entry;
                best_sync = &sync;
                best_waiter = waiter;
            }
            break;  // entries ascend: the first that follows is the one
        }
    }
    if (best == nullptr) {
        return {fmt::format("{}:signal(after {} of {}) -> {}:wait(before {} of {})", name(first.actor),
                            toString(first.kind), what, late.name, toString(second.kind), what),
                false,
                {},
                {},
                {}};
    }
    EdgeText text{{},
                  best_waiter != nullptr,
                  (best_waiter != nullptr ? *best_waiter : late).name,
                  actors[best->by.actor].name,
                  syncText(*best_sync, best->value)};
    text.edge = fmt::format("{0}:signal({2}, {3}) -> {1}:wait({2}, {3})", text.signaller, text.waiter, best_sync->name,
                            best->value);
    return text;
}

void Ledger::State::nameEdges(const Sync& sync, const Entry& entry) {
    const auto named = [&](const OpenRace& one) {
        const Actor& late = actors[one.waiting];
        if (!entry.know.order().covers(one.at) || waiterFor(sync, late) == nullptr) {
            return false;
        }
        tellRace(one, missingEdge(one.at, one.early, late, one.late, one.name));
        return !one.release_to_come;
    };
    open_races.erase(std::remove_if(open_races.begin(), open_races.end(), named), open_races.end());
}

}  // namespace sluice::ledger
