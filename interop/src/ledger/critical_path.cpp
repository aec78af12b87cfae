// SPDX-License-Identifier: MIT
#include <algorithm>

#include "sluice/ledger/report.hpp"

namespace sluice::ledger {

std::vector<PathPart> criticalPath(const Recording& recording, const std::vector<Step>& steps,
                                   const std::vector<std::uint32_t>& events) {
    if (events.empty()) {
        return {};
    }
    std::uint32_t at = events.front();
    for (const std::uint32_t event : events) {
        at = steps[event].end_ns >= steps[at].end_ns ? event : at;
    }
    const std::uint32_t frame = recording.events[at].frame;
    std::vector<PathPart> path;
    std::uint64_t until = steps[at].end_ns;
    // A cause was placed before what it caused, and so was what came before: the walk cannot return.
    while (true) {
        const Step& step = steps[at];
        const std::uint32_t actor = recording.events[at].actor;
        const bool inside = step.cause != kNone && recording.events[step.cause].frame == frame;
        if (inside) {
            const std::uint64_t begin = std::min(steps[step.cause].end_ns, until);
            path.push_back({actor, begin, until, at});
            until = begin;
            at = step.cause;
        } else if (step.cause == kNone && step.previous != kNone && recording.events[step.previous].frame == frame) {
            at = step.previous;
        } else {
            // Held up by another frame, or the actor's first event in this one.
            const std::uint64_t begin =
                step.cause == kNone ? step.begin_ns : std::max(step.begin_ns, steps[step.cause].end_ns);
            path.push_back({actor, std::min(begin, until), until, step.cause == kNone ? kNone : at});
            break;
        }
    }
    std::ranges::reverse(path);
    return path;
}

}  // namespace sluice::ledger
