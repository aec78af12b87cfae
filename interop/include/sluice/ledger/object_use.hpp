// SPDX-License-Identifier: MIT
// What Event::object numbers, by the event's kind: the ledger, its log and what is computed of a log agree on it here.
#pragma once

#include <cstdint>

#include "sluice/ledger/event.hpp"

namespace sluice::ledger {

enum class ObjectUse : std::uint8_t { None, Sync, Resource, Actor };

/// None: nothing, or a descriptor, whose number is the system's.
[[nodiscard]] constexpr ObjectUse objectUse(const Event& event) {
    switch (event.kind) {
        case EventKind::Signal:
        case EventKind::Wait:
        case EventKind::WaitBegin:
            return ObjectUse::Sync;
        case EventKind::Submit:
            return ObjectUse::Actor;
        case EventKind::Read:
        case EventKind::Write:
        case EventKind::Release:
        case EventKind::Acquire:
        case EventKind::Layout:
        case EventKind::Names:
        case EventKind::Export:
        case EventKind::Import:
        case EventKind::Witness:
            return ObjectUse::Resource;
        case EventKind::Destroy:
            return event.aux == static_cast<std::uint16_t>(ObjectClass::Sync)       ? ObjectUse::Sync
                   : event.aux == static_cast<std::uint16_t>(ObjectClass::Resource) ? ObjectUse::Resource
                                                                                    : ObjectUse::None;
        case EventKind::FdOpen:
        case EventKind::FdGive:
        case EventKind::FdClose:
        case EventKind::Frame:
        case EventKind::ActorEnd:
            break;
    }
    return ObjectUse::None;
}

}  // namespace sluice::ledger
