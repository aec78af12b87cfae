// SPDX-License-Identifier: MIT
#include "ledger/log_bounds.hpp"

#include "ledger/log_bytes.hpp"

namespace sluice::ledger {
namespace {

std::optional<Outside> above(std::size_t at, const char* what, std::uint64_t found, std::uint64_t bound) {
    return found < bound ? std::nullopt : std::optional(Outside{at, what, found, bound});
}

template <typename Enum>
constexpr std::uint64_t countUpTo(Enum last) {
    return static_cast<std::uint64_t>(last) + 1;
}

}  // namespace

std::optional<Outside> outsideOfBounds(const std::byte* from) {
    if (auto kind = above(0, "a kind of event", readNumber<std::uint8_t>(from), kEventKindCount)) {
        return kind;
    }
    const auto event = readNumber<Event>(from);
    if (auto actor = above(offsetof(Event, actor), "an actor", event.actor, kMaxActors)) {
        return actor;
    }
    constexpr std::size_t kObject = offsetof(Event, object), kAux = offsetof(Event, aux);
    // What `object` and `aux` number depends on the kind; descriptors are numbers of the system's and free.
    switch (event.kind) {
        case EventKind::Submit:
            return above(kObject, "a stream", event.object, kMaxActors);
        case EventKind::Release:
        case EventKind::Acquire:
            if (event.aux != kNoActor && event.aux >= kMaxActors) {
                return above(kAux, "the other owner", event.aux, kMaxActors);
            }
            return above(kObject, "a resource", event.object, kMaxObjects);
        case EventKind::Destroy:
            if (auto sort = above(kAux, "a class of object", event.aux, countUpTo(ObjectClass::Fd))) {
                return sort;
            }
            return event.aux == static_cast<std::uint16_t>(ObjectClass::Fd)
                       ? std::nullopt
                       : above(kObject, "an object", event.object, kMaxObjects);
        case EventKind::Witness:
            if (auto verdict = above(kAux, "a verdict", event.aux, countUpTo(Verdict::Torn))) {
                return verdict;
            }
            return above(kObject, "a resource", event.object, kMaxObjects);
        case EventKind::Signal:
        case EventKind::Wait:
        case EventKind::WaitBegin:
            return above(kObject, "a sync object", event.object, kMaxObjects);
        case EventKind::Read:
        case EventKind::Write:
        case EventKind::Layout:
        case EventKind::Names:
        case EventKind::Export:
        case EventKind::Import:
            return above(kObject, "a resource", event.object, kMaxObjects);
        case EventKind::FdOpen:
        case EventKind::FdGive:
        case EventKind::FdClose:
        case EventKind::Frame:
        case EventKind::ActorEnd:
            break;
    }
    return std::nullopt;
}

}  // namespace sluice::ledger
