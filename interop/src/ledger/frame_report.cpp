// SPDX-License-Identifier: MIT
#include "sluice/ledger/report.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace sluice::ledger {
namespace {

using Interval = std::pair<std::uint64_t, std::uint64_t>;
using Causes = std::map<std::tuple<std::string, std::string, std::string>, Stall>;

struct Samples {
    std::vector<std::uint64_t> hand_off, wake_up;
    Causes causes;
    std::uint64_t stalled_ns = 0;
};

std::vector<Stall> sorted(const Causes& causes) {
    std::vector<Stall> stalls;
    for (const auto& [key, stall] : causes) {
        stalls.push_back(stall);
    }
    std::ranges::stable_sort(stalls, std::ranges::greater{}, &Stall::total_ns);
    return stalls;
}

std::uint64_t lengthOfUnion(std::vector<Interval> intervals) {
    std::ranges::sort(intervals);
    std::uint64_t length = 0, reached = 0;
    for (const auto& [begin, end] : intervals) {
        const std::uint64_t from = std::max(begin, reached);
        length += end > from ? end - from : 0;
        reached = std::max(reached, end);
    }
    return length;
}

void addWait(const Recording& recording, const std::vector<Step>& steps, std::uint32_t i, Samples& samples) {
    const RecordedEvent& recorded = recording.events[i];
    const Step& step = steps[i];
    if (step.signal != kNone && !steps[step.signal].inferred) {
        const Step& signal = steps[step.signal];
        const std::uint64_t latency = step.end_ns > signal.end_ns ? step.end_ns - signal.end_ns : 0;
        samples.hand_off.push_back(latency);
        if (recorded.event.duration_ns > 0 && step.begin_ns < signal.end_ns) {
            samples.wake_up.push_back(latency);
        }
    }
    if (step.length() == 0) {
        return;
    }
    const std::string& waiting = recording.actors[recorded.actor].name;
    const std::string& sync = recording.syncs[recorded.object].name;
    const std::string signaller =
        step.signal == kNone ? std::string{} : recording.actors[recording.events[step.signal].actor].name;
    Stall& stall = samples.causes[{waiting, sync, signaller}];
    stall.waiting = waiting;
    stall.sync = sync;
    stall.signaller = signaller;
    ++stall.waits;
    stall.total_ns += step.length();
    stall.longest_ns = std::max(stall.longest_ns, step.length());
    samples.stalled_ns += step.length();
}

/// The overlap of one frame, from each actor's busy intervals.
void addOverlap(const Recording& recording, const std::vector<Step>& steps, const std::vector<std::uint32_t>& events,
                FrameReport& report) {
    struct Busy {
        std::uint64_t since = 0, until = 0, total = 0;
        bool seen = false;
    };
    std::map<std::uint32_t, Busy> actors;
    std::vector<Interval> intervals;
    const auto close = [&intervals](Busy& busy, std::uint64_t end) {
        if (end > busy.since) {
            intervals.emplace_back(busy.since, end);
            busy.total += end - busy.since;
        }
    };
    for (const std::uint32_t i : events) {
        const Step& step = steps[i];
        Busy& busy = actors[recording.events[i].actor];
        if (!busy.seen) {
            busy = {step.begin_ns, step.begin_ns, 0, true};
        }
        const bool submitted = step.cause != kNone && recording.events[step.cause].event.kind == EventKind::Submit;
        if (submitted) {
            // A stream with nothing to do until then.
            close(busy, busy.until);
            busy.since = step.begin_ns;
        }
        if (recording.events[i].event.kind == EventKind::Wait) {
            close(busy, step.begin_ns);
            busy.since = step.end_ns;
        }
        busy.until = std::max(busy.until, step.end_ns);
    }
    std::uint64_t sum = 0, longest = 0;
    for (auto& [actor, busy] : actors) {
        close(busy, busy.until);
        sum += busy.total;
        longest = std::max(longest, busy.total);
    }
    report.overlap_achieved_ns = sum - lengthOfUnion(std::move(intervals));
    report.overlap_possible_ns = sum - longest;
}

FrameReport reportFrame(const Recording& recording, const std::vector<Step>& steps,
                        const std::vector<std::uint32_t>& events) {
    FrameReport report;
    report.frame = recording.events[events.front()].frame;
    report.begin_ns = steps[events.front()].begin_ns;
    Samples samples;
    for (const std::uint32_t i : events) {
        report.begin_ns = std::min(report.begin_ns, steps[i].begin_ns);
        report.end_ns = std::max(report.end_ns, steps[i].end_ns);
        if (recording.events[i].event.kind == EventKind::Wait) {
            addWait(recording, steps, i, samples);
        }
    }
    report.path = criticalPath(recording, steps, events);
    report.stalls = sorted(samples.causes);
    report.stalled_ns = samples.stalled_ns;
    report.hand_off = distribution(std::move(samples.hand_off));
    report.wake_up = distribution(std::move(samples.wake_up));
    addOverlap(recording, steps, events, report);
    return report;
}

/// What ends after a frame was the last of its actor or object; how long that was put off is no time of the frame's.
bool endsSomething(const Event& event) {
    return event.kind == EventKind::ActorEnd || event.kind == EventKind::Destroy;
}

}  // namespace

Distribution distribution(std::vector<std::uint64_t> values) {
    if (values.empty()) {
        return {};
    }
    std::ranges::sort(values);
    const std::size_t n = values.size();
    // Rank of share a/b among n, from 1: the ceiling of n * a / b.
    const auto ranked = [&values, n](std::size_t a, std::size_t b) { return values[(n * a + b - 1) / b - 1]; };
    return {n, values.front(), ranked(1, 2), ranked(99, 100), values.back()};
}

Report makeReport(const Recording& recording, const std::vector<Step>& steps) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> frames;
    Samples all;
    for (std::uint32_t i = 0; i < recording.events.size(); ++i) {
        if (recording.events[i].frame != 0 && !endsSomething(recording.events[i].event)) {
            frames[recording.events[i].frame].push_back(i);
        }
        if (recording.events[i].event.kind == EventKind::Wait) {
            addWait(recording, steps, i, all);
        }
    }
    Report report;
    std::vector<std::uint64_t> spans;
    for (const auto& [number, events] : frames) {
        report.frames.push_back(reportFrame(recording, steps, events));
        const FrameReport& frame = report.frames.back();
        report.overlap_achieved_ns += frame.overlap_achieved_ns;
        report.overlap_possible_ns += frame.overlap_possible_ns;
        spans.push_back(frame.end_ns - frame.begin_ns);
    }
    report.stalls = sorted(all.causes);
    report.stalled_ns = all.stalled_ns;
    report.hand_off = distribution(std::move(all.hand_off));
    report.wake_up = distribution(std::move(all.wake_up));
    report.frame_span = distribution(std::move(spans));
    return report;
}

}  // namespace sluice::ledger
