// SPDX-License-Identifier: MIT
// Signals and waits: how knowledge goes from one actor to another.
#include <algorithm>

#include <fmt/format.h>

#include "state.hpp"

namespace sluice::ledger {
namespace {

/// A side without lists (a Vulkan queue, a thread) that gives no names hands over all memory.
bool namesEverything(const Actor& by, const std::vector<Named>& names) {
    return names.empty() && by.kind != ActorKind::GlContext;
}

const Clock* findNamed(const Entry& entry, Slot resource) {
    for (const auto& [named, clock] : entry.named) {
        if (named == resource) {
            return &clock;
        }
    }
    return nullptr;
}

Clock& namedAt(Entry& entry, Slot resource) {
    for (auto& [named, clock] : entry.named) {
        if (named == resource) {
            return clock;
        }
    }
    return entry.named.emplace_back(resource, Clock{}).second;
}

}  // namespace

void Ledger::State::publish(Actor& by, Knowledge& into) {
    by.know.raise(by.now());
    ++by.tick;
    into = by.know;
}

SyncUse& Ledger::State::useOf(Sync& sync, const Actor& by, const Event& event) {
    const auto found =
        std::find_if(sync.uses.begin(), sync.uses.end(), [&](const SyncUse& use) { return use.at.actor == by.slot; });
    SyncUse& use = found == sync.uses.end() ? sync.uses.emplace_back() : *found;
    use.at = by.now();
    use.last = event;
    return use;
}

void Ledger::State::fillEntry(Actor& by, Sync& sync, Entry& entry, const Event& event,
                              const std::vector<Named>& names) {
    const Entry* lower = sync.entries.empty() ? nullptr : &sync.entries.back();
    entry.value = event.value;
    entry.by = by.now();
    entry.signal = event;
    publish(by, entry.know);
    if (lower != nullptr) {
        entry.know.absorb(lower->know);
    }
    if (!sync.listedOnly()) {
        return;
    }
    if (lower != nullptr) {
        entry.everything = lower->everything;
        entry.named = lower->named;
    }
    const Sight* sight = by.know.sight();
    if (namesEverything(by, names)) {
        entry.everything.join(by.know.visible());
        if (sight != nullptr) {
            for (const auto& [resource, seen] : sight->listed) {
                namedAt(entry, resource).join(seen);
            }
        }
    }
    for (const Named& one : names) {
        Clock& clock = namedAt(entry, one.resource);
        clock.join(by.know.visible());
        if (const Clock* seen = sight != nullptr ? sight->find(one.resource) : nullptr) {
            clock.join(*seen);
        }
    }
}

void Ledger::State::signal(Actor& by, const Item& item) {
    Sync& sync = syncs[item.slot];
    const Event& event = item.event;
    const auto names = std::exchange(by.names, {});
    if (sync.destroyed) {
        if (auto* found = report(FindingKind::UseAfterDestroy, sync.id, *sync.destroyed, event)) {
            found->sentence = fmt::format("{} signals {} in frame {}, which {} has destroyed.", by.name, sync.name,
                                          event.frame, name(sync.destroyed->actor));
            found->remedy = fmt::format("Destroy {} after the last signal of {}.", sync.name, by.name);
        }
        return;
    }
    namedAtSignal(by, names);
    threadSignalled(by);
    useOf(sync, by, event).signalled = true;
    if (sync.kind == SyncKind::Timeline) {
        if (event.value <= sync.current) {
            if (event.value > sync.forced) {
                const Event& before = sync.entries.empty() ? event : sync.entries.back().signal;
                if (auto* found = report(FindingKind::TimelineNotIncreasing, sync.id, before, event)) {
                    found->sentence = fmt::format("{} signals {} with {} in frame {}, which has already reached {}.",
                                                  by.name, sync.name, event.value, event.frame, sync.current);
                    found->remedy = fmt::format("Signal {} with at least {} here.", sync.name, sync.current + 1);
                }
            }
            return;  // it changes nothing: waits for it have passed already
        }
        if (event.value - sync.current > options.max_timeline_gap) {
            const Event& before = sync.entries.empty() ? event : sync.entries.back().signal;
            if (auto* found = report(FindingKind::TimelineGap, sync.id, before, event)) {
                found->sentence = fmt::format("{} raises {} from {} to {}, more than the limit of {}.", by.name,
                                              sync.name, sync.current, event.value, options.max_timeline_gap);
                found->remedy = fmt::format("Raise {} in smaller steps; is {} what was meant?", sync.name, event.value);
            }
        }
        sync.current = event.value;
        sync.forced = (event.flags & kForced) != 0 ? event.value : sync.forced;
    } else if (!sync.entries.empty()) {
        if (auto* found = report(FindingKind::BinarySignalledTwice, sync.id, sync.entries.back().signal, event)) {
            found->sentence =
                fmt::format("{} signals the {} {} in frame {} while the signal of {} from frame {} is still there.",
                            by.name, toString(sync.kind), sync.name, event.frame,
                            name(sync.entries.back().signal.actor), sync.entries.back().signal.frame);
            found->remedy = sync.kind == SyncKind::Fence
                                ? fmt::format("Reset {} before it is used again, and declare it anew.", sync.name)
                                : fmt::format("Let somebody wait for {} before it is signalled again.", sync.name);
        }
        sync.blamed = true;
        return;
    } else if (sync.consumed && !by.after(sync.consumed_at)) {
        if (auto* found = report(FindingKind::BinaryReusedPending, sync.id, *sync.consumed, event)) {
            found->edge = missingEdge(sync.consumed_at, *sync.consumed, by, event, sync.name).edge;
            found->sentence = fmt::format(
                "{} signals {} anew in frame {}, and nothing says that the wait of {} in "
                "frame {} has run.",
                by.name, sync.name, event.frame, name(sync.consumed->actor), sync.consumed->frame);
            found->remedy = fmt::format(
                "Let {} first wait for something that {} signals after that wait, or take "
                "another semaphore.",
                by.name, name(sync.consumed->actor));
        }
    }
    if (sync.entries.size() >= std::max(sync.prune_at, options.prune_above)) {
        prune(sync);
    }
    Entry entry;
    fillEntry(by, sync, entry, event, names);
    sync.entries.push_back(std::move(entry));
    nameEdges(sync, sync.entries.back());
    runnable.insert(runnable.end(), sync.waiters.begin(), sync.waiters.end());
    sync.waiters.clear();
}

bool Ledger::State::absorbEntry(Actor& by, const Sync& sync, const Entry& entry, const std::vector<Named>& names) {
    if (!sync.listedOnly()) {
        return by.know.absorb(entry.know);
    }
    bool rose = by.know.absorbOrder(entry.know.order());
    if (namesEverything(by, names)) {
        rose |= by.know.seeAll(entry.everything);
        for (const auto& [resource, clock] : entry.named) {
            rose |= by.know.see(resource, clock);
        }
    }
    for (const Named& one : names) {
        rose |= by.know.see(one.resource, entry.everything);
        if (const Clock* clock = findNamed(entry, one.resource)) {
            rose |= by.know.see(one.resource, *clock);
        }
    }
    by.know.settle();
    return rose;
}

bool Ledger::State::wait(Actor& by, const Item& item) {
    Sync& sync = syncs[item.slot];
    const Event& event = item.event;
    const bool timed_out = (event.flags & kTimedOut) != 0;
    const bool gave_up = (event.flags & kGaveUp) != 0;
    if (sync.destroyed || timed_out || gave_up) {
        by.names.clear();
        by.open_wait.reset();
    }
    if (gave_up) {
        return true;
    }
    if (timed_out) {
        if (auto* found = report(FindingKind::WaitTimedOut, sync.id, event, event, event.duration_ns)) {
            found->edge = fmt::format("? -> {}:wait({}, {})", by.name, sync.name, event.value);
            found->sentence =
                fmt::format("{} gave up waiting for {} after {:.3f} ms in frame {}; it stood at {}.", by.name,
                            syncText(sync, event.value), static_cast<double>(event.duration_ns) * 1e-6, event.frame,
                            sync.kind == SyncKind::Timeline ? std::to_string(sync.current) : "unsignalled");
            found->remedy = fmt::format("Find out who should have signalled {}, and leave its work out of this frame.",
                                        syncText(sync, event.value));
        }
        return true;
    }
    if (sync.destroyed) {
        if (auto* found = report(FindingKind::UseAfterDestroy, sync.id, *sync.destroyed, event)) {
            found->sentence = fmt::format("{} waits for {} in frame {}, which {} has destroyed.", by.name, sync.name,
                                          event.frame, name(sync.destroyed->actor));
            found->remedy = fmt::format("Destroy {} after the last wait of {}.", sync.name, by.name);
        }
        return true;
    }
    if (!satisfied(item)) {
        if (std::find(sync.waiters.begin(), sync.waiters.end(), by.slot) == sync.waiters.end()) {
            sync.waiters.push_back(by.slot);
        }
        return false;
    }
    const auto names = std::exchange(by.names, {});
    by.open_wait.reset();
    SyncUse& use = useOf(sync, by, event);
    auto entry = sync.kind == SyncKind::Timeline && event.value <= sync.initial
                     ? sync.entries.end()
                     : std::lower_bound(sync.entries.begin(), sync.entries.end(),
                                        sync.kind == SyncKind::Timeline ? event.value : 0,
                                        [](const Entry& one, std::uint64_t value) { return one.value < value; });
    if (entry == sync.entries.end()) {
        namedAtWait(names);
        return true;  // the initial value: nothing is ordered
    }
    const bool candidate = mayBeOverWait(by, event);
    Clock before = candidate ? by.know.order() : Clock{};
    if (by.gift) {
        by.gift->without.join(entry->know.order());
    }
    const bool rose = absorbEntry(by, sync, *entry, names);
    namedAtWait(names);
    if (!rose && options.performance) {
        uselessWait(by, sync, *entry, use, event);
    } else if (candidate) {
        threadWaited(by, item.slot, *entry, event, std::move(before));
    }
    use.waited = true;
    use.waited_value = std::max(use.waited_value, event.value);
    use.met_value = std::max(use.met_value, entry->value);
    if (sync.kind == SyncKind::Binary) {
        sync.consumed = event;
        sync.consumed_at = by.now();
        sync.entries.clear();
    }
    return true;
}

}  // namespace sluice::ledger
