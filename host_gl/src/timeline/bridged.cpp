// SPDX-License-Identifier: MIT
// BRIDGED: a GL fence per signal, waited for by a thread which then signals the renderer from the CPU. It runs on every
// driver with GL_ARB_sync and lets the GL thread go on at once.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "timeline/backends.hpp"
#include "timeline/bridge_thread.hpp"
#include "timeline/cpu_wait.hpp"
#include "timeline/timeline_events.hpp"

namespace sluice::host {

namespace {

class BridgedTimeline final : public HostTimeline {
  public:
    BridgedTimeline(TimelineDeps deps, std::unique_ptr<BridgeThread> bridge)
        : deps_(std::move(deps)), bridge_(std::move(bridge)) {}

    [[nodiscard]] SluiceTimelineKind kind() const override { return SLUICE_TIMELINE_BRIDGED; }

    [[nodiscard]] Status signal(std::uint64_t value, std::span<const std::uint32_t> /*textures*/) override {
        if (std::optional<Error> error = bridge_->takeError()) {
            return *error;
        }
        const std::uint64_t begin = traceClock(deps_.trace);
        // Before the fence: Mesa (seen with 22.3.6) keeps the last vertices of immediate mode back until something
        // flushes them, glFenceSync does not, and the fence would then arrive ahead of what it was put behind.
        glFlush();
        const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
        if (fence == nullptr) {
            return Error{SLUICE_ERROR_DEVICE_LOST, "bridged timeline", "glFenceSync returned no fence",
                         "the GL context may be lost"};
        }
        // After it too, and by this thread: glClientWaitSync on another context cannot flush the commands of this one.
        glFlush();
        if (deps_.feed != nullptr) {
            deps_.feed->fencePromised(value);
        }
        bridge_->promise(fence, value);
        traceStep(deps_.trace, SLUICE_TRACE_MARK, SLUICE_TRACK_HOST_CPU, SLUICE_HOST_TO_RENDERER, value, begin,
                  "queue GL fence");
        return {};
    }

    [[nodiscard]] Status wait(std::uint64_t value, std::uint64_t timeout_ns,
                              std::span<const std::uint32_t> /*textures*/) override {
        // The renderer cannot reach frame k before gbufferWritten(k), so nothing is lost by waiting for that first. It
        // keeps this thread out of vkWaitSemaphores while the bridge is inside vkSignalSemaphore for the same frame;
        // docs/validation.md tells what the validation layer was seen to do when both were inside.
        const std::uint64_t begin = monotonicNanoseconds();
        if (!bridge_->waitUntilKept(gbufferWritten(value), timeout_ns)) {
            if (std::optional<Error> error = bridge_->takeError()) {
                return *error;
            }
            tellWatchdog(deps_, value, begin);
            return Error{SLUICE_TIMEOUT, "bridged timeline",
                         fmt::format("the GL fence of value {} did not arrive within {:.3f} s", gbufferWritten(value),
                                     static_cast<double>(timeout_ns) * 1e-9),
                         "raise wait_timeout_ns; the host's own GL work takes longer"};
        }
        timeout_ns -= std::min(monotonicNanoseconds() - begin, timeout_ns);
        Status status = waitOnCpu(deps_, value, timeout_ns, &bridge_->failed());
        // A failed bridge is the cause of whatever the wait ended with.
        if (std::optional<Error> error = bridge_->takeError()) {
            return *error;
        }
        return status;
    }

  private:
    TimelineDeps deps_;
    std::unique_ptr<BridgeThread> bridge_;
};

}  // namespace

Result<std::unique_ptr<HostTimeline>> makeBridgedTimeline(const TimelineDeps& deps) {
    if (epoxy_gl_version() < 32 && !epoxy_has_gl_extension("GL_ARB_sync")) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "timeline bridged", "the GL driver has no GL_ARB_sync",
                     "request timeline 'finish'"};
    }
    Result<BridgeContext> context = BridgeContext::createSharedWithCurrent();
    if (!context) {
        return context.error();
    }
    Result<std::unique_ptr<BridgeThread>> bridge = BridgeThread::start(std::move(context).value(), deps);
    if (!bridge) {
        return bridge.error();
    }
    return std::unique_ptr<HostTimeline>(std::make_unique<BridgedTimeline>(deps, std::move(bridge).value()));
}

}  // namespace sluice::host
