// SPDX-License-Identifier: MIT
#include "timeline/cpu_wait.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "timeline/timeline_events.hpp"

namespace sluice::host {

namespace {

// How often a blocked wait looks whether it is still worth waiting.
constexpr std::uint64_t kSliceNs = 50'000'000;

SluiceResult waitInSlices(const TimelineDeps& deps, std::uint64_t value, std::uint64_t timeout_ns,
                          const std::atomic<bool>* hopeless) {
    if (hopeless == nullptr) {
        return deps.api->timeline_wait(deps.renderer, value, timeout_ns);
    }
    const std::uint64_t begin = monotonicNanoseconds();
    for (;;) {
        const std::uint64_t spent = monotonicNanoseconds() - begin;
        const std::uint64_t left = timeout_ns - std::min(spent, timeout_ns);
        const SluiceResult result = deps.api->timeline_wait(deps.renderer, value, std::min(left, kSliceNs));
        if (result != SLUICE_TIMEOUT || left <= kSliceNs || hopeless->load()) {
            return result;
        }
    }
}

}  // namespace

Status waitOnCpu(const TimelineDeps& deps, std::uint64_t value, std::uint64_t timeout_ns,
                 const std::atomic<bool>* hopeless) {
    const std::uint64_t begin = traceClock(deps.trace);
    const SluiceResult result = waitInSlices(deps, value, timeout_ns, hopeless);
    traceStep(deps.trace, SLUICE_TRACE_WAIT, SLUICE_TRACK_HOST_CPU, SLUICE_RENDERER_TO_HOST, value, begin,
              "wait for renderer");
    if (result == SLUICE_TIMEOUT) {
        return Error{SLUICE_TIMEOUT, "renderer's timeline",
                     fmt::format("did not reach {} within {:.3f} s", value, static_cast<double>(timeout_ns) * 1e-9),
                     "raise wait_timeout_ns, or look at the trace for what the renderer waits for"};
    }
    if (result != SLUICE_OK) {
        return Error{result < 0 ? result : SLUICE_ERROR_INTERNAL, "renderer's timeline",
                     fmt::format("waiting for {} failed with code {}", value, static_cast<int>(result)),
                     "destroy the renderer and create it again"};
    }
    return {};
}

Status signalFromCpu(const TimelineDeps& deps, std::uint64_t value, SluiceTrack track) {
    const std::uint64_t begin = traceClock(deps.trace);
    const SluiceResult result = deps.api->timeline_signal(deps.renderer, value);
    if (result != SLUICE_OK) {
        return Error{result < 0 ? result : SLUICE_ERROR_INTERNAL, "host's timeline",
                     fmt::format("signalling {} failed with code {}", value, static_cast<int>(result)),
                     "destroy the renderer and create it again"};
    }
    traceStep(deps.trace, SLUICE_TRACE_SIGNAL, track, SLUICE_HOST_TO_RENDERER, value, begin, "signal renderer");
    return {};
}

}  // namespace sluice::host
