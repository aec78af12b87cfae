// SPDX-License-Identifier: MIT
#include "timeline/cpu_wait.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "sluice/abi_sizes.hpp"
#include "timeline/timeline_events.hpp"

namespace sluice::host {

namespace {

// How often a blocked wait looks whether it is still worth waiting.
constexpr std::uint64_t kSliceNs = 50'000'000;

std::string_view inWords(std::int32_t result) {
    switch (result) {
        case SLUICE_ERROR_INVALID_ARGUMENT:
            return "the renderer refuses that value";
        case SLUICE_ERROR_OUT_OF_MEMORY:
            return "out of memory";
        case SLUICE_ERROR_DEVICE_LOST:
            return "the renderer is lost";
        case SLUICE_ERROR_INTERNAL:
            return "an internal fault of the renderer";
        default:
            return "sluice/plugin.h has its meaning";
    }
}

/// `gave_up`: not the time has passed, but hope.
SluiceResult waitInSlices(const TimelineDeps& deps, std::uint64_t value, std::uint64_t timeout_ns,
                          const std::atomic<bool>* hopeless, bool& gave_up) {
    if (hopeless == nullptr) {
        return deps.api->timeline_wait(deps.renderer, value, timeout_ns);
    }
    const std::uint64_t begin = monotonicNanoseconds();
    for (;;) {
        const std::uint64_t spent = monotonicNanoseconds() - begin;
        const std::uint64_t left = timeout_ns - std::min(spent, timeout_ns);
        const SluiceResult result = deps.api->timeline_wait(deps.renderer, value, std::min(left, kSliceNs));
        gave_up = result == SLUICE_TIMEOUT && hopeless->load();
        if (result != SLUICE_TIMEOUT || left <= kSliceNs || gave_up) {
            return result;
        }
    }
}

}  // namespace

Status waitOnCpu(const TimelineDeps& deps, std::uint64_t value, std::uint64_t timeout_ns,
                 const std::atomic<bool>* hopeless) {
    const std::uint64_t begin = traceClock(deps.trace, deps.feed);
    if (deps.feed != nullptr) {
        deps.feed->hostWaits(value);
    }
    bool gave_up = false;
    const SluiceResult result = waitInSlices(deps, value, timeout_ns, hopeless, gave_up);
    traceStep(deps.trace, SLUICE_TRACE_WAIT, SLUICE_TRACK_HOST_CPU, SLUICE_RENDERER_TO_HOST, value, begin,
              "wait for renderer");
    const bool failed = result != SLUICE_OK && result != SLUICE_TIMEOUT;
    if ((gave_up || failed) && deps.feed != nullptr) {
        deps.feed->hostGaveUp(value, begin);
    }
    if (gave_up) {
        return Error{SLUICE_ERROR_DEVICE_LOST, "renderer's timeline",
                     fmt::format("gave up waiting for {}: it can no longer be reached", value),
                     "destroy the renderer and create it again"};
    }
    if (result == SLUICE_TIMEOUT) {
        tellWatchdog(deps, value, begin);
        return Error{SLUICE_TIMEOUT, "renderer's timeline",
                     fmt::format("did not reach {} within {:.3f} s", value, static_cast<double>(timeout_ns) * 1e-9),
                     "raise wait_timeout_ns, or look at the trace for what the renderer waits for"};
    }
    if (failed) {
        return Error{
            result < 0 ? result : SLUICE_ERROR_INTERNAL, "renderer's timeline",
            fmt::format("waiting for {} failed with code {}: {}", value, static_cast<int>(result), inWords(result)),
            "destroy the renderer and create it again"};
    }
    if (deps.feed != nullptr) {
        deps.feed->hostWaited(value, begin, false);
    }
    return {};
}

void tellWatchdog(const TimelineDeps& deps, std::uint64_t value, std::uint64_t begin_ns) {
    if (deps.feed == nullptr) {
        return;
    }
    // What has ended on the queue comes to the ledger when its frame is polled; the chain shall not name that.
    const std::uint64_t oldest = value > SLUICE_MAX_IMAGE_SETS ? value - SLUICE_MAX_IMAGE_SETS : 1;
    for (std::uint64_t frame = oldest; frame <= value; ++frame) {
        auto stats = sized<SluiceFrameStats>();
        (void)deps.api->poll(deps.renderer, frame, &stats);
    }
    if (deps.log) {
        const auto waited = static_cast<double>(monotonicNanoseconds() - begin_ns) * 1e-9;
        deps.log(
            SLUICE_LOG_WARNING,
            fmt::format("watchdog: the host has waited {:.3f} s for renderer-to-host >= {} and goes on without the "
                        "fluid. Who waits for whom:\n{}",
                        waited, value, deps.feed->waitForChain(value)));
    }
    deps.feed->hostWaited(value, begin_ns, true);
}

Status signalFromCpu(const TimelineDeps& deps, std::uint64_t value, SluiceTrack track) {
    const std::uint64_t begin = traceClock(deps.trace);
    if (deps.feed != nullptr) {
        // Before the call: what the renderer does then must not come to the ledger first. A value that it refuses was
        // wrong, and the ledger says so.
        if (track == SLUICE_TRACK_BRIDGE) {
            deps.feed->bridgeSignals(value);
        } else {
            deps.feed->hostSignals(value);
        }
    }
    const SluiceResult result = deps.api->timeline_signal(deps.renderer, value);
    if (result != SLUICE_OK) {
        return Error{
            result < 0 ? result : SLUICE_ERROR_INTERNAL, "host's timeline",
            fmt::format("signalling {} failed with code {}: {}", value, static_cast<int>(result), inWords(result)),
            "destroy the renderer and create it again"};
    }
    traceStep(deps.trace, SLUICE_TRACE_SIGNAL, track, SLUICE_HOST_TO_RENDERER, value, begin, "signal renderer");
    return {};
}

}  // namespace sluice::host
