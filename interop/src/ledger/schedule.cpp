// SPDX-License-Identifier: MIT
#include "sluice/ledger/schedule.hpp"

#include <algorithm>
#include <deque>
#include <iterator>
#include <unordered_map>

namespace sluice::ledger {
namespace {

std::uint64_t after(std::uint64_t time, std::uint64_t duration) {
    return duration > ~time ? ~std::uint64_t{0} : time + duration;
}

struct Signals {
    std::vector<std::uint32_t> at;       ///< events
    std::vector<std::uint64_t> reached;  ///< the highest value up to each, so that a binary search finds the first
    std::size_t consumed = 0;            ///< binary: waits so far
};

bool isWait(const RecordedEvent& recorded) {
    return recorded.event.kind == EventKind::Wait && (recorded.event.flags & (kTimedOut | kGaveUp)) == 0;
}

std::uint32_t satisfier(const RecordedSync& sync, Signals& signals, std::uint64_t value) {
    switch (sync.kind) {
        case SyncKind::Binary:
            return signals.consumed < signals.at.size() ? signals.at[signals.consumed++] : kNone;
        case SyncKind::Fence:
            return signals.at.empty() ? kNone : signals.at.front();
        case SyncKind::Timeline:
            break;
    }
    const auto first = std::ranges::lower_bound(signals.reached, value);
    if (value <= sync.initial || first == signals.reached.end()) {
        return kNone;
    }
    return signals.at[static_cast<std::size_t>(first - signals.reached.begin())];
}

void linkSignals(const Recording& recording, std::vector<Step>& steps) {
    std::vector<Signals> syncs(recording.syncs.size());
    for (std::uint32_t i = 0; i < recording.events.size(); ++i) {
        const RecordedEvent& recorded = recording.events[i];
        if (recorded.event.kind == EventKind::Signal) {
            Signals& signals = syncs[recorded.object];
            signals.at.push_back(i);
            signals.reached.push_back(signals.reached.empty() ? recorded.event.value
                                                              : std::max(signals.reached.back(), recorded.event.value));
        }
    }
    for (std::uint32_t i = 0; i < recording.events.size(); ++i) {
        const RecordedEvent& recorded = recording.events[i];
        if (isWait(recorded)) {
            steps[i].signal = satisfier(recording.syncs[recorded.object], syncs[recorded.object], recorded.event.value);
        }
    }
}

/// When threads that stood still for them say that signals of streams have come, by event; 0: nobody does.
std::vector<std::uint64_t> arrivals(const Recording& recording, const std::vector<Step>& steps) {
    std::vector<std::uint64_t> arrived(steps.size(), 0);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const RecordedEvent& wait = recording.events[i];
        if (steps[i].signal == kNone || wait.event.duration_ns < kHeldNs ||
            isStream(recording.actors[wait.actor].kind)) {
            continue;
        }
        const RecordedEvent& signal = recording.events[steps[i].signal];
        if (!isStream(recording.actors[signal.actor].kind) || signal.event.duration_ns != 0 ||
            signal.event.time_ns > wait.event.time_ns) {
            continue;
        }
        std::uint64_t& known = arrived[steps[i].signal];
        const std::uint64_t end = after(wait.event.time_ns, wait.event.duration_ns);
        known = known == 0 ? end : std::min(known, end);
    }
    return arrived;
}

/// Places events one by one; an actor whose next event depends on one that has no place yet stands aside until it has.
class Placer {
  public:
    Placer(const Recording& recording, std::vector<Step>& steps)
        : recording_(recording),
          steps_(steps),
          arrived_(arrivals(recording, steps)),
          submitted_(recording.events.size(), kNone),
          placed_(recording.events.size(), false),
          queues_(recording.actors.size()) {
        std::vector<std::uint32_t> last(recording.actors.size(), kNone), submit(recording.actors.size(), kNone);
        for (std::uint32_t i = 0; i < recording.events.size(); ++i) {
            const RecordedEvent& recorded = recording.events[i];
            steps_[i].previous = last[recorded.actor];
            submitted_[i] = submit[recorded.actor];
            last[recorded.actor] = i;
            if (recorded.event.kind == EventKind::Submit && recorded.object != recorded.actor) {
                submit[recorded.object] = i;
            }
        }
    }

    void run() {
        for (std::uint32_t i = 0; i < recording_.events.size(); ++i) {
            std::deque<std::uint32_t>& queue = queues_[recording_.events[i].actor];
            queue.push_back(i);
            if (queue.size() == 1) {
                drain(recording_.events[i].actor);
            }
        }
        // What is left waits in a circle, or for one that does: it is put where it was logged.
        for (std::uint32_t i = 0; i < recording_.events.size(); ++i) {
            if (!placed_[i]) {
                place(i, false);
            }
        }
    }

  private:
    /// An event that has to be placed before `i`, or kNone.
    std::uint32_t missing(std::uint32_t i) const {
        for (const std::uint32_t needed : {steps_[i].signal, submitted_[i]}) {
            if (needed != kNone && !placed_[needed]) {
                return needed;
            }
        }
        return kNone;
    }
    void drain(std::uint32_t first) {
        std::vector<std::uint32_t> ready{first};
        while (!ready.empty()) {
            std::deque<std::uint32_t>& queue = queues_[ready.back()];
            const std::uint32_t actor = ready.back();
            if (queue.empty()) {
                ready.pop_back();
                continue;
            }
            const std::uint32_t event = queue.front();
            if (const std::uint32_t needed = missing(event); needed != kNone) {
                waiting_[needed].push_back(actor);
                ready.pop_back();
                continue;
            }
            place(event, true);
            queue.pop_front();
            if (const auto woken = waiting_.find(event); woken != waiting_.end()) {
                const std::vector<std::uint32_t> actors = std::move(woken->second);
                waiting_.erase(woken);
                // GCC 14 misreads the growth of a range insert here (-Wstringop-overflow).
                std::copy(actors.begin(), actors.end(), std::back_inserter(ready));
            }
        }
    }
    void place(std::uint32_t i, bool in_order) {
        const RecordedEvent& recorded = recording_.events[i];
        Step& step = steps_[i];
        step.begin_ns = recorded.event.time_ns;
        if (step.previous != kNone) {
            step.begin_ns = std::max(step.begin_ns, steps_[step.previous].end_ns);
        }
        if (const std::uint32_t submit = submitted_[i]; submit != kNone && in_order) {
            step.begin_ns = std::max(step.begin_ns, steps_[submit].end_ns);
            const bool first = step.previous == kNone || steps_[step.previous].end_ns < steps_[submit].end_ns;
            step.cause = first ? submit : kNone;
        }
        step.end_ns = std::max(step.begin_ns, after(recorded.event.time_ns, recorded.event.duration_ns));
        if (step.signal != kNone && in_order) {
            const std::uint64_t signalled = steps_[step.signal].end_ns;
            if (recorded.event.duration_ns == 0 && isStream(recording_.actors[recorded.actor].kind)) {
                step.end_ns = std::max(step.end_ns, signalled);
            }
            step.cause = step.end_ns > step.begin_ns && signalled > step.begin_ns ? step.signal : step.cause;
        }
        if (arrived_[i] > step.end_ns) {
            step.end_ns = arrived_[i];
            step.inferred = true;
        }
        placed_[i] = true;
    }

    const Recording& recording_;
    std::vector<Step>& steps_;
    std::vector<std::uint64_t> arrived_;
    std::vector<std::uint32_t> submitted_;
    std::vector<bool> placed_;
    std::vector<std::deque<std::uint32_t>> queues_;
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> waiting_;  ///< actors, by the event they wait for
};

}  // namespace

bool isStream(ActorKind kind) {
    return kind == ActorKind::GlContext || kind == ActorKind::VulkanQueue;
}

std::vector<Step> schedule(const Recording& recording) {
    std::vector<Step> steps(recording.events.size());
    linkSignals(recording, steps);
    Placer(recording, steps).run();
    return steps;
}

}  // namespace sluice::ledger
