// SPDX-License-Identifier: MIT
#include "ledger/log_bounds.hpp"

#include "ledger/log_bytes.hpp"
#include "sluice/ledger/object_use.hpp"

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
    std::optional<Outside> aux;
    if (event.kind == EventKind::Destroy) {
        aux = above(kAux, "a class of object", event.aux, countUpTo(ObjectClass::Fd));
    } else if (event.kind == EventKind::Witness) {
        aux = above(kAux, "a verdict", event.aux, countUpTo(Verdict::Torn));
    } else if ((event.kind == EventKind::Release || event.kind == EventKind::Acquire) && event.aux != kNoActor) {
        aux = above(kAux, "the other owner", event.aux, kMaxActors);
    }
    if (aux) {
        return aux;
    }
    switch (objectUse(event)) {
        case ObjectUse::Actor:
            return above(kObject, "a stream", event.object, kMaxActors);
        case ObjectUse::Sync:
            return above(kObject, "a sync object", event.object, kMaxObjects);
        case ObjectUse::Resource:
            return above(kObject, "a resource", event.object, kMaxObjects);
        case ObjectUse::None:
            break;
    }
    return std::nullopt;
}

}  // namespace sluice::ledger
