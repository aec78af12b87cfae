// SPDX-License-Identifier: MIT
// Waits that are right but cost something. Both rules would rather miss one than accuse a well-written program.
//
// useless-wait: the wait orders nothing new, and
//   - the same actor has waited for that value, or a higher one, of the same sync before, or
//   - the actor gave that signal itself, or
//   - it is a thread that lost at least kImpliedCostNs with it, though another sync had told it already.
// A wait for a timeline's initial value is never told: loops start that way.
//
// over-wait: a thread stood still for a signal, and afterwards
//   - touched nothing itself that the signal orders, and signalled nothing (a bridge does that, and it is its job);
//   - a stream that it submitted to did touch something that only this wait orders; and
//   - that stream could have waited: streams of its kind signal or wait for this very sync in this log; a fence only
//     where GL gave it and GL would wait, since nothing but the CPU can wait for a VkFence.
// Judged when eight later waits of the thread have passed, or at the end.
#include <algorithm>

#include <fmt/format.h>

#include "state.hpp"

namespace sluice::ledger {
namespace {

constexpr std::uint64_t kImpliedCostNs = 100'000;  // well above the cost of a call that returns at once

Candidate* findCandidate(Actor& thread, std::uint64_t serial) {
    if (serial == 0 || !thread.candidates) {
        return nullptr;
    }
    Candidate& candidate = (*thread.candidates)[serial % thread.candidates->size()];
    return candidate.serial == serial ? &candidate : nullptr;
}

}  // namespace

void Ledger::State::uselessWait(const Actor& by, const Sync& sync, const Entry& entry, const SyncUse& use,
                                const Event& event) {
    const bool again = use.waited && sync.kind != SyncKind::Binary &&
                       (sync.kind == SyncKind::Fence || event.value <= use.waited_value);
    const bool own = entry.by.actor == by.slot;
    // Where an earlier wait met a later signal in the place of a forgotten one, that is what it knows more, not the
    // program.
    const bool forgotten = sync.kind == SyncKind::Timeline && event.value <= use.met_value;
    const bool dear = by.isThread() && event.duration_ns >= kImpliedCostNs && !forgotten;
    if (event.duration_ns < options.useless_wait_ns || !(again || own || dear)) {
        return;
    }
    if (auto* found = report(FindingKind::UselessWait, sync.id, entry.signal, event, event.duration_ns)) {
        found->edge = fmt::format("{0}:signal({1}, {2}) -> {3}:wait({1}, {4})", name(entry.signal.actor), sync.name,
                                  entry.value, by.name, event.value);
        found->sentence =
            fmt::format("{} waits for {} in frame {} for {:.3f} ms, though {}.", by.name, syncText(sync, event.value),
                        event.frame, static_cast<double>(event.duration_ns) * 1e-6,
                        again ? "it has waited for that before"
                        : own ? "it gave that signal itself"
                              : "other waits of its own had implied that already");
        found->remedy = fmt::format("Leave out the wait of {} for {}.", by.name, sync.name);
    }
}

bool Ledger::State::mayBeOverWait(const Actor& by, const Event& event) const {
    return options.performance && by.isThread() && event.duration_ns > 0 &&
           event.duration_ns >= options.useless_wait_ns;
}

void Ledger::State::threadWaited(Actor& by, Slot sync, const Entry& entry, const Event& event, Clock before) {
    if (!by.candidates) {
        by.candidates = std::make_unique<std::array<Candidate, 8>>();
    }
    by.newest_candidate = ++candidate_serial;
    Candidate& candidate = (*by.candidates)[candidate_serial % by.candidates->size()];
    judge(by, candidate);
    candidate = Candidate{candidate_serial, entry.signal, event, sync,   std::move(before),
                          by.know.order(),  false,        false, kNoSlot};
}

void Ledger::State::threadSignalled(Actor& by) {
    if (by.candidates) {
        for (Candidate& candidate : *by.candidates) {
            candidate.excused = true;
        }
    }
}

void Ledger::State::gift(const Actor& from, std::uint64_t candidate, Actor& stream) {
    const Candidate* wait = findCandidate(actors[from.slot], candidate);
    if (wait == nullptr || wait->excused) {
        return;
    }
    if (!stream.gift) {
        stream.gift = std::make_unique<Gift>();
    }
    stream.gift->thread = from.slot;
    stream.gift->candidate = candidate;
    stream.gift->without = stream.know.order();
    stream.gift->without.raise(from.now());
}

void Ledger::State::needed(Actor& by, Epoch epoch) {
    if (by.candidates) {
        for (Candidate& candidate : *by.candidates) {
            candidate.excused |= !candidate.before.covers(epoch) && candidate.after.covers(epoch);
        }
    }
    if (!by.gift || epoch.actor == by.slot || by.gift->without.covers(epoch)) {
        return;
    }
    Candidate* candidate = findCandidate(actors[by.gift->thread], by.gift->candidate);
    if (candidate == nullptr || candidate->before.covers(epoch) || !candidate->after.covers(epoch)) {
        return;
    }
    const Sync& sync = syncs[candidate->sync];
    const bool known_here = std::any_of(sync.uses.begin(), sync.uses.end(), [&](const SyncUse& use) {
        return !actors[use.at.actor].isThread() && actors[use.at.actor].kind == by.kind;
    });
    const bool could = known_here && (sync.kind != SyncKind::Fence || by.kind == ActorKind::GlContext);
    candidate->used |= could;
    candidate->excused |= !could;
    candidate->stream = by.slot;
}

void Ledger::State::judge(Actor& thread, Candidate& candidate) {
    if (candidate.serial == 0 || !candidate.used || candidate.excused) {
        candidate.serial = 0;
        return;
    }
    const Sync& sync = syncs[candidate.sync];
    const Event& wait = candidate.wait;
    if (auto* found = report(FindingKind::OverWait, sync.id, candidate.signal, wait, wait.duration_ns)) {
        const std::string& stream = actors[candidate.stream].name;
        found->edge = fmt::format("{0}:signal({1}, {2}) -> {3}:wait({1}, {4})", name(candidate.signal.actor), sync.name,
                                  candidate.signal.value, thread.name, wait.value);
        found->sentence =
            fmt::format("{} stands still for {:.3f} ms in frame {} until {}, which only {} needed.", thread.name,
                        static_cast<double>(wait.duration_ns) * 1e-6, wait.frame, syncText(sync, wait.value), stream);
        found->remedy = fmt::format("Let {} wait for {} and submit at once.", stream, syncText(sync, wait.value));
    }
    candidate.serial = 0;
}

}  // namespace sluice::ledger
