// SPDX-License-Identifier: MIT
// FINISH: the GPU is idle before anything is promised. The baseline that the others are compared with.
#include <epoxy/gl.h>

#include <memory>
#include <utility>

#include "timeline/backends.hpp"
#include "timeline/cpu_wait.hpp"
#include "timeline/timeline_events.hpp"

namespace sluice::host {

namespace {

class FinishTimeline final : public HostTimeline {
  public:
    explicit FinishTimeline(TimelineDeps deps) : deps_(std::move(deps)) {}

    [[nodiscard]] SluiceTimelineKind kind() const override { return SLUICE_TIMELINE_FINISH; }

    [[nodiscard]] Status signal(std::uint64_t value, std::span<const std::uint32_t> /*textures*/) override {
        const std::uint64_t begin = traceClock(deps_.trace, deps_.feed);
        glFinish();
        if (deps_.feed != nullptr) {
            deps_.feed->glFinished(begin);
        }
        return signalFromCpu(deps_, value, SLUICE_TRACK_HOST_CPU);
    }

    [[nodiscard]] Status wait(std::uint64_t value, std::uint64_t timeout_ns,
                              std::span<const std::uint32_t> /*textures*/) override {
        return waitOnCpu(deps_, value, timeout_ns, nullptr);
    }

  private:
    TimelineDeps deps_;
};

}  // namespace

std::unique_ptr<HostTimeline> makeFinishTimeline(const TimelineDeps& deps) {
    return std::make_unique<FinishTimeline>(deps);
}

}  // namespace sluice::host
