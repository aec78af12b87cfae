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

std::string accessText(const Event& event) {
    const bool content = event.kind == EventKind::Read || event.kind == EventKind::Write;
    return content && event.value != 0 ? fmt::format("{} of version {}", toString(event.kind), event.value)
                                       : std::string(toString(event.kind));
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

}  // namespace sluice::ledger
