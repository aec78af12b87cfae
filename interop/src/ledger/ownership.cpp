// SPDX-License-Identifier: MIT
// Who owns a resource, and in which layout the two sides believe it to be.
#include <fmt/format.h>

#include "state.hpp"

namespace sluice::ledger {
namespace {

std::uint32_t oldLayout(const Event& event) {
    return static_cast<std::uint32_t>(event.value);
}
std::uint32_t newLayout(const Event& event) {
    return static_cast<std::uint32_t>(event.value >> 32U);
}

}  // namespace

void Ledger::State::checkOwner(Actor& by, Resource& resource, const Event& event) {
    const auto& pending = resource.release;
    const bool on_its_way = pending && (pending->event.aux != kNoActor || pending->event.actor == by.id);
    const bool is_acquire = event.kind == EventKind::Acquire;
    const bool foreign = resource.owner != kNoActor && resource.owner != by.id;
    const bool wrong_hands = is_acquire ? pending && ((pending->event.aux != kNoActor && pending->event.aux != by.id) ||
                                                      (event.aux != kNoActor && event.aux != pending->event.actor))
                                        : on_its_way || (pending && event.kind == EventKind::Release);
    if (foreign || wrong_hands) {
        const Event& before = pending ? pending->event : resource.write_event;
        const bool known_before = pending || before.actor != kNoActor;
        if (auto* found = report(FindingKind::OwnershipMismatch, resource.id, known_before ? before : event, event)) {
            const std::string state = pending ? fmt::format("{} has released it to {}", name(pending->event.actor),
                                                            pending->event.aux == kNoActor ? std::string("the outside")
                                                                                           : name(pending->event.aux))
                                              : fmt::format("{} owns it", name(resource.owner));
            found->edge =
                fmt::format("{0}:release({1}) -> {2}:acquire({1})",
                            pending ? name(pending->event.actor) : name(resource.owner), resource.name, by.name);
            found->sentence = fmt::format("{} {} {} in frame {}, but {}.", by.name, verb(event.kind), resource.name,
                                          event.frame, state);
            found->remedy = fmt::format("Release {} to {} first, and let {} acquire it before it is touched there.",
                                        resource.name, by.name, by.name);
        }
        resource.owner = kNoActor;  // said once; what follows from it is not told again
        resource.release.reset();
    }
    switch (event.kind) {
        case EventKind::Release:
            return release(by, resource, event);
        case EventKind::Acquire:
            return acquire(by, resource, event);
        case EventKind::Layout:
            return layoutChange(resource, event);
        default:
            return;
    }
}

void Ledger::State::release(Actor& by, Resource& resource, const Event& event) {
    layoutChange(resource, event);
    resource.owner = kNoActor;
    resource.release = Release{event, by.now(), oldLayout(event), newLayout(event)};
    resource.retaken.reset();
}

void Ledger::State::acquire(Actor& by, Resource& resource, const Event& event) {
    // Either half of a queue family transfer repeats the whole transition; others name the layout that the release
    // left.
    const bool repeats = resource.release && resource.release->old_layout == oldLayout(event) &&
                         resource.release->new_layout == newLayout(event) && resource.layout == newLayout(event);
    if (repeats) {
        resource.layout_event = event;
    } else {
        layoutChange(resource, event);
    }
    const bool own = resource.release && resource.release->event.actor == by.id;
    resource.retaken = own ? std::move(resource.release) : std::nullopt;
    resource.owner = by.id;
    resource.release.reset();
}

void Ledger::State::layoutChange(Resource& resource, const Event& event) {
    // From UNDEFINED is always allowed: the contents are given up.
    if (oldLayout(event) != 0 && resource.layout != 0 && oldLayout(event) != resource.layout) {
        layoutMismatch(resource, event, oldLayout(event));
    }
    resource.layout = newLayout(event);
    resource.layout_event = event;
}

void Ledger::State::layoutMismatch(Resource& resource, const Event& event, std::uint32_t named) {
    const bool told = resource.layout_event.actor != kNoActor;
    if (auto* found = report(FindingKind::LayoutMismatch, resource.id, told ? resource.layout_event : event, event)) {
        found->edge = fmt::format("{}: layout {} -> {}: layout {}",
                                  told ? name(resource.layout_event.actor) : std::string("declaration"),
                                  resource.layout, name(event.actor), named);
        found->sentence =
            fmt::format("{} takes {} to be in layout {} in frame {}, but {} left it in layout {}.", name(event.actor),
                        resource.name, named, event.frame,
                        told ? name(resource.layout_event.actor) : std::string("its declaration"), resource.layout);
        found->remedy = fmt::format("Name layout {} in the {} of {}, or leave {} in layout {} before.", resource.layout,
                                    toString(event.kind), name(event.actor), resource.name, named);
    }
}

void Ledger::State::namedAtSignal(Actor& by, const std::vector<Named>& names) {
    for (const Named& one : names) {
        Resource& resource = resources[one.resource];
        if (one.layout == 0) {
            continue;
        }
        // A GL signal moves the texture into the layout that it names; others have said so by their own transitions.
        if (by.kind != ActorKind::GlContext && resource.layout != 0 && resource.layout != one.layout &&
            resource.layout_event.actor == by.id) {
            layoutMismatch(resource, one.event, one.layout);
        }
        resource.layout = one.layout;
        resource.layout_event = one.event;
    }
}

void Ledger::State::namedAtWait(const std::vector<Named>& names) {
    for (const Named& one : names) {
        Resource& resource = resources[one.resource];
        if (one.layout != 0 && resource.layout != 0 && one.layout != resource.layout) {
            layoutMismatch(resource, one.event, one.layout);
            resource.layout = one.layout;
            resource.layout_event = one.event;
        }
    }
}

}  // namespace sluice::ledger
