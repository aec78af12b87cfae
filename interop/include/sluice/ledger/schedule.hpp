// SPDX-License-Identifier: MIT
// When the events of a recording took place, and what each wait and submission waited for.
//
// A log has the time at which an event was *logged*. A thread's events take place then. A stream (GL context, Vulkan
// queue) is logged while it is being fed and runs later, so its events are moved to the earliest time that the log
// allows:
// - an event begins when it was logged, but not before the end of what its actor did before, nor before the end of the
//   Submit that it came with;
// - it ends after its logged duration; a stream's wait without one ends at the end of the signal that satisfied it.
// - what the log says of a stream's signal, without a duration, is when it was recorded. A thread that asked for it
// later
//   and then stood still (kHeldNs or more) knows better: the signal ended when that wait did.
// So a stream's times are lower bounds, except for those of waits and accesses that were logged with durations.
#pragma once

#include <cstdint>
#include <vector>

#include "sluice/ledger/recording.hpp"

namespace sluice::ledger {

/// Longer than a wait for what is already there takes: 1 to 10 us were seen, with GL fences and Vulkan timelines.
inline constexpr std::uint64_t kHeldNs = 50'000;

struct Step {
    std::uint64_t begin_ns = 0, end_ns = 0;
    std::uint32_t signal = kNone;    ///< a Wait: the Signal that satisfied it
    std::uint32_t cause = kNone;     ///< the Signal or Submit that decided when this event ended or began; else kNone
    std::uint32_t previous = kNone;  ///< of the same actor
    bool inferred = false;           ///< a Signal: when it ended was taken from a thread's wait for it
    /// A Wait: how long its actor stood still.
    [[nodiscard]] std::uint64_t length() const { return end_ns - begin_ns; }
};

/// One step per event of the recording. A timeline's wait is satisfied by the first signal, in the log's order, of at
/// least its value; the n-th wait on a binary object by the n-th signal; any wait on a fence by its first signal. Waits
/// that timed out and waits for the initial value have none.
[[nodiscard]] std::vector<Step> schedule(const Recording& recording);

[[nodiscard]] bool isStream(ActorKind kind);

}  // namespace sluice::ledger
