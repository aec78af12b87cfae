// SPDX-License-Identifier: MIT
#include "sync/renderer_timeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "device/structs.hpp"
#include "sluice/format.hpp"
#include "sluice/timeline.hpp"

namespace sluice::vk {
namespace {

// GL signals by itself, after work of any length. To give up too early leaks the device (BINARY), or makes GL signal a
// value that the counter has passed (NATIVE).
constexpr std::uint64_t kGpuGraceNs = 10'000'000'000;
// How often drain() looks whether a counter has moved.
constexpr std::uint64_t kLookNs = 100'000'000;

VkSemaphoreSubmitInfo submitInfo(VkSemaphore semaphore, std::uint64_t value) {
    auto info = vkStruct<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
    info.semaphore = semaphore;
    info.value = value;  // ignored for binary semaphores
    info.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    return info;
}

VkResult waitFor(const Device& device, VkSemaphore semaphore, std::uint64_t value, std::uint64_t timeout_ns) {
    auto info = vkStruct<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
    info.semaphoreCount = 1;
    info.pSemaphores = &semaphore;
    info.pValues = &value;
    return device.fn.vkWaitSemaphores(device.handle, &info, timeout_ns);
}

}  // namespace

RendererTimeline::RendererTimeline(const Device& device, SluiceTimelineKind kind)
    : device_(device), kind_(kind), binary_host_to_renderer_(device), binary_renderer_to_host_(device) {}

Result<std::unique_ptr<RendererTimeline>> RendererTimeline::create(const Device& device, SluiceTimelineKind kind) {
    auto timeline = std::make_unique<RendererTimeline>(device, kind);
    const bool exportable = kind == SLUICE_TIMELINE_NATIVE;
    Result<VkSemaphore> host =
        createSemaphore(device, VK_SEMAPHORE_TYPE_TIMELINE, exportable, "timeline host to renderer");
    if (!host) {
        return host.error();
    }
    timeline->host_to_renderer_ = host.value();
    Result<VkSemaphore> renderer =
        createSemaphore(device, VK_SEMAPHORE_TYPE_TIMELINE, exportable, "timeline renderer to host");
    if (!renderer) {
        return renderer.error();
    }
    timeline->renderer_to_host_ = renderer.value();
    return timeline;
}

RendererTimeline::~RendererTimeline() {
    device_.fn.vkDestroySemaphore(device_.handle, host_to_renderer_, nullptr);
    device_.fn.vkDestroySemaphore(device_.handle, renderer_to_host_, nullptr);
}

bool RendererTimeline::cpuSignals() const {
    return kind_ == SLUICE_TIMELINE_BRIDGED || kind_ == SLUICE_TIMELINE_FINISH ||
           kind_ == SLUICE_TIMELINE_UNSYNCHRONISED;
}

Result<SubmitSemaphores> RendererTimeline::forSubmit(std::uint64_t wait_value, std::uint64_t signal_value,
                                                     bool skip_wait) {
    SubmitSemaphores out;
    if (!skip_wait && kind_ != SLUICE_TIMELINE_UNSYNCHRONISED) {
        if (kind_ == SLUICE_TIMELINE_BINARY) {
            VkSemaphore semaphore = binary_host_to_renderer_.find(wait_value);
            if (semaphore == VK_NULL_HANDLE) {
                return Error{SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("host value {}", wait_value),
                             "no binary semaphore was asked for", "call timeline_export before submit_frame"};
            }
            out.waits.push_back(submitInfo(semaphore, 0));
        } else {
            if (kind_ == SLUICE_TIMELINE_FINISH) {
                Result<std::uint64_t> now = value(SLUICE_HOST_TO_RENDERER);
                if (!now) {
                    return now.error();
                }
                if (now.value() < wait_value) {
                    return Error{SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("host value {}", wait_value),
                                 fmt::format("the counter is still at {}", now.value()),
                                 "with the finish timeline, call timeline_signal before submit_frame"};
                }
            }
            out.waits.push_back(submitInfo(host_to_renderer_, wait_value));
        }
    }
    if (kind_ == SLUICE_TIMELINE_BINARY) {
        Result<VkSemaphore> semaphore = binary_renderer_to_host_.obtain(signal_value);
        if (!semaphore) {
            return semaphore.error();
        }
        out.signals.push_back(submitInfo(semaphore.value(), 0));
    }
    out.signals.push_back(submitInfo(renderer_to_host_, signal_value));
    return out;
}

HostPromise RendererTimeline::promiseOf(std::uint64_t wait_value, bool skip_wait) const {
    const bool waits = !skip_wait && cpuSignals() && kind_ != SLUICE_TIMELINE_UNSYNCHRONISED;
    return waits ? HostPromise{promises_, wait_value} : HostPromise{};
}

void RendererTimeline::submitted(std::uint64_t wait_value, std::uint64_t signal_value, bool skip_wait) {
    if (!skip_wait && kind_ != SLUICE_TIMELINE_UNSYNCHRONISED) {
        last_wait_ = std::max(last_wait_, wait_value);
    }
    promises_->submitted(promiseOf(wait_value, skip_wait).value, signal_value);
    last_signal_ = std::max(last_signal_, signal_value);
}

Status RendererTimeline::signal(std::uint64_t value) {
    if (!cpuSignals()) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "timeline_signal",
                     fmt::format("a {} timeline is signalled by the GL command stream", toString(kind_)), ""};
    }
    const std::lock_guard guard(signal_lock_);
    if (value > signalled_ && value <= forced_) {
        signalled_ = value;  // the promise came after drain() had kept it
        return {};
    }
    if (value <= signalled_) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("timeline_signal({})", value),
                     fmt::format("the counter is already at {}", signalled_), "values only ever increase"};
    }
    auto info = vkStruct<VkSemaphoreSignalInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO);
    info.semaphore = host_to_renderer_;
    info.value = value;
    if (const VkResult result = device_.fn.vkSignalSemaphore(device_.handle, &info); result != VK_SUCCESS) {
        promises_->broken();
        return vulkanError(result, fmt::format("vkSignalSemaphore({})", value));
    }
    promises_->kept(value);
    signalled_ = value;
    return {};
}

SluiceResult RendererTimeline::wait(std::uint64_t value, std::uint64_t timeout_ns) const {
    const auto deadline = deadlineIn(timeout_ns);
    if (!promises_->waitUntilFree(value, deadline)) {
        return SLUICE_TIMEOUT;
    }
    const VkResult result = waitFor(device_, renderer_to_host_, value, leftUntil(deadline));
    if (result == VK_SUCCESS) {
        return SLUICE_OK;
    }
    return result == VK_TIMEOUT ? SLUICE_TIMEOUT : vulkanError(result, "").code;
}

Result<std::uint64_t> RendererTimeline::value(SluiceDirection direction) const {
    const bool from_host = direction == SLUICE_HOST_TO_RENDERER;
    const bool inferred = from_host && kind_ == SLUICE_TIMELINE_BINARY;
    std::uint64_t value = 0;
    const VkResult result = device_.fn.vkGetSemaphoreCounterValue(
        device_.handle, from_host && !inferred ? host_to_renderer_ : renderer_to_host_, &value);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "vkGetSemaphoreCounterValue");
    }
    if (inferred && value > 0) {
        value = gbufferWritten(value);
    }
    return value;
}

Result<UniqueFd> RendererTimeline::exportFd(SluiceDirection direction, std::uint64_t value) {
    const bool from_host = direction == SLUICE_HOST_TO_RENDERER;
    if (kind_ == SLUICE_TIMELINE_NATIVE) {
        return exportSemaphore(device_, from_host ? host_to_renderer_ : renderer_to_host_);
    }
    if (kind_ == SLUICE_TIMELINE_BINARY) {
        return (from_host ? binary_host_to_renderer_ : binary_renderer_to_host_).exportFd(value);
    }
    return Error{SLUICE_ERROR_INVALID_ARGUMENT, "timeline_export",
                 fmt::format("a {} timeline has nothing to export", toString(kind_)),
                 "use timeline_signal and timeline_wait"};
}

void RendererTimeline::retireFrame(std::uint64_t frame) {
    binary_host_to_renderer_.retireThrough(gbufferWritten(frame));
    binary_renderer_to_host_.retireThrough(fluidWritten(frame));
}

void RendererTimeline::force(std::uint64_t from, std::uint64_t through) {
    const std::lock_guard guard(signal_lock_);
    // One by one: validation layer 1.3.239 takes a host signal that jumps over a value that a submission waits for as
    // pending for ever, and reports VUID-VkSemaphoreSignalInfo-value-03259 on the next signal.
    for (std::uint64_t value = std::max(from, signalled_) + 1; value <= through; ++value) {
        auto info = vkStruct<VkSemaphoreSignalInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO);
        info.semaphore = host_to_renderer_;
        info.value = value;
        if (device_.fn.vkSignalSemaphore(device_.handle, &info) != VK_SUCCESS) {
            promises_->broken();
            return;
        }
        promises_->kept(value);
        forced_ = value;
    }
}

Drained RendererTimeline::idle() const {
    return device_.waitIdle() == VK_SUCCESS ? Drained::Idle : Drained::Lost;
}

std::uint64_t RendererTimeline::graceOf(SluiceTimelineKind kind, std::uint64_t grace_ns) {
    const bool gl_signals = kind == SLUICE_TIMELINE_NATIVE || kind == SLUICE_TIMELINE_BINARY;
    return gl_signals ? std::max(grace_ns, kGpuGraceNs) : grace_ns;
}

SluiceResult RendererTimeline::waitWhileMoving(std::uint64_t grace_ns) const {
    using Clock = std::chrono::steady_clock;
    const auto counters = [this]() -> std::optional<std::pair<std::uint64_t, std::uint64_t>> {
        const Result<std::uint64_t> host = value(SLUICE_HOST_TO_RENDERER);
        const Result<std::uint64_t> renderer = value(SLUICE_RENDERER_TO_HOST);
        return host && renderer ? std::optional(std::pair(host.value(), renderer.value())) : std::nullopt;
    };
    auto seen = counters();
    auto moved = Clock::now();
    for (;;) {
        const SluiceResult result = wait(last_signal_, std::min(grace_ns, kLookNs));
        if (result != SLUICE_TIMEOUT) {
            return result;
        }
        const auto now = counters();
        if (now != seen) {
            seen = now;
            moved = Clock::now();
        } else if (Clock::now() - moved >= std::chrono::nanoseconds(grace_ns)) {
            return SLUICE_TIMEOUT;
        }
    }
}

Drained RendererTimeline::drain(std::uint64_t grace_ns) {
    if (last_signal_ == 0 || waitWhileMoving(graceOf(kind_, grace_ns)) != SLUICE_TIMEOUT) {
        return idle();
    }
    Result<std::uint64_t> host = value(SLUICE_HOST_TO_RENDERER);
    if (!host) {
        promises_->broken();
        return Drained::Lost;
    }
    if (host.value() < last_wait_) {
        if (kind_ == SLUICE_TIMELINE_BINARY) {
            return Drained::Stuck;
        }
        device_.log(SLUICE_LOG_WARNING,
                    fmt::format("host timeline: value {} was promised and never came; moved on from {} so that "
                                "submitted frames end",
                                last_wait_, host.value()));
        force(host.value(), last_wait_);
    }
    // Slow work is no fault: without an unkept promise it ends, however long it takes.
    return idle();
}

}  // namespace sluice::vk
