// SPDX-License-Identifier: MIT
// Where the time of each frame went. Pure: numbers of a recording and its schedule (schedule.hpp says when an event
// takes place).
//
// Definitions, for the events of one frame:
// - span: from the earliest begin to the latest end.
// - stall: a wait's time from begin to end. Its cause is who waited, for which object, and who signalled it.
// - busy: an actor's time from its first to its last event of the frame, less its stalls, and, of a stream, less the
// time
//   in which it had nothing to do until the next submission. A log does not say when a thread sleeps for another
//   reason, so that counts as busy, unless its sleep is logged as a wait. So does a wait that nobody ever satisfied:
//   its length is not known; the findings tell of it.
// - overlap achieved: the sum of all busy times less the length of their union: what running side by side saved against
//   running one after the other.
// - overlap possible: the sum of all busy times less the longest: what would be saved if all else ran beside the
// busiest.
//   It needs frames that overlap as well; within one frame the order may forbid it. achieved <= possible.
// - hand-off latency: from the end of a signal to the end of a wait that it satisfied, 0 if the logged times say less.
// A
//   signal that lies ready for a while before anybody asks makes it long: that is slack.
// - wake-up latency: the same over those waits alone that had begun before their signal and whose duration was
// measured:
//   what the hand-over itself costs.
// - critical path: backward from the frame's last end. A wait that was held up leads to its signal, a stream's work
// that
//   was held up by its submission leads to the submitting thread, all else to what the actor did before. It ends where
//   the frame begins. Shortening anything that is not on it does not shorten the frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sluice/ledger/schedule.hpp"

namespace sluice::ledger {

/// Nearest rank: the smallest value that at least that share of all values does not exceed. All 0 when count is 0.
struct Distribution {
    std::uint64_t count = 0, min_ns = 0, median_ns = 0, p99_ns = 0, max_ns = 0;
};
[[nodiscard]] Distribution distribution(std::vector<std::uint64_t> values);

/// By names, because a fence of each frame is an object of its own.
struct Stall {
    std::string waiting, sync, signaller;  ///< signaller is empty when nobody signalled
    std::uint64_t waits = 0, total_ns = 0, longest_ns = 0;
};

/// One actor's part of the critical path.
struct PathPart {
    std::uint32_t actor = kNone;
    std::uint64_t begin_ns = 0, end_ns = 0;
    std::uint32_t entered_by =
        kNone;  ///< event: the wait or the first submitted work that began it; kNone at the start
};

struct FrameReport {
    std::uint32_t frame = 0;
    std::uint64_t begin_ns = 0, end_ns = 0;
    std::vector<PathPart> path;  ///< in order of time
    std::vector<Stall> stalls;   ///< longest total first; none of length 0
    std::uint64_t stalled_ns = 0;
    std::uint64_t overlap_achieved_ns = 0, overlap_possible_ns = 0;
    Distribution hand_off, wake_up;
};

struct Report {
    std::vector<FrameReport> frames;  ///< by number; events outside of frames (0) are in none
    std::vector<Stall> stalls;        ///< over all frames
    std::uint64_t stalled_ns = 0, overlap_achieved_ns = 0, overlap_possible_ns = 0;
    Distribution hand_off, wake_up;  ///< over the whole log
    Distribution frame_span;
};

[[nodiscard]] Report makeReport(const Recording& recording, const std::vector<Step>& steps);

/// The parts of a frame's critical path; `events` are that frame's, in the log's order.
[[nodiscard]] std::vector<PathPart> criticalPath(const Recording& recording, const std::vector<Step>& steps,
                                                 const std::vector<std::uint32_t>& events);

}  // namespace sluice::ledger
