// SPDX-License-Identifier: MIT
// From a broken rule to a Finding: told once per site, with names.
#include <fmt/format.h>

#include "state.hpp"

namespace sluice::ledger {

std::string verb(EventKind kind) {
    switch (kind) {
        case EventKind::Read:
            return "reads";
        case EventKind::Write:
            return "writes";
        case EventKind::Release:
            return "releases";
        case EventKind::Acquire:
            return "acquires";
        case EventKind::Layout:
            return "changes the layout of";
        default:
            return fmt::format("does a {} of", toString(kind));
    }
}

Finding* Ledger::State::report(FindingKind kind, ObjectId object, const Event& first, const Event& second,
                               std::uint64_t cost) {
    const Key key{kind, object, first.actor, first.kind, second.actor, second.kind};
    const auto old = known.find(key);
    if (old != known.end()) {
        ++findings[old->second].count;
        findings[old->second].cost_ns += cost;
        return nullptr;
    }
    if (findings.size() >= options.max_findings) {
        ++dropped;
        return nullptr;
    }
    known.emplace(key, findings.size());
    Finding& fresh = findings.emplace_back();
    fresh.kind = kind;
    fresh.first = first;
    fresh.second = second;
    fresh.frame = second.frame;
    fresh.cost_ns = cost;
    fresh.remedy = findingInfo(kind).remedy;
    return &fresh;
}

std::string Ledger::State::name(ActorId id) const {
    const Slot slot = actor_slots.find(id);
    return slot == kNoSlot ? "actor " + std::to_string(id) : actors[slot].name;
}

std::string Ledger::State::syncText(const Sync& sync, std::uint64_t value) const {
    return sync.kind == SyncKind::Timeline ? fmt::format("{} >= {}", sync.name, value)
                                           : fmt::format("the {} {}", toString(sync.kind), sync.name);
}

std::string Ledger::State::missingEdge(const Epoch& at, const Event& first, const Actor& by, const Event& second,
                                       const std::string& what) const {
    // Best named by a signal that follows the first event and that the second actor could have waited for; one on a
    // sync that it does wait for elsewhere is the likeliest.
    const Sync* best = nullptr;
    const Entry* signal = nullptr;
    for (const Sync& sync : syncs) {
        for (const Entry& entry : sync.entries) {
            if (entry.by.actor != at.actor || entry.by.tick < at.tick) {
                continue;
            }
            bool waits = false;
            for (const SyncUse& use : sync.uses) {
                waits |= use.at.actor == by.slot && use.waited;
            }
            if (best == nullptr || waits) {
                best = &sync;
                signal = &entry;
            }
            break;  // entries ascend: the first that follows is the one
        }
    }
    if (best != nullptr) {
        return fmt::format("{0}:signal({2}, {3}) -> {1}:wait({2}, {3})", name(first.actor), by.name, best->name,
                           signal->value);
    }
    return fmt::format("{}:signal(after {} of {}) -> {}:wait(before {} of {})", name(first.actor), toString(first.kind),
                       what, by.name, toString(second.kind), what);
}

}  // namespace sluice::ledger
