// SPDX-License-Identifier: MIT
// UNSYNCHRONISED: every promise is a lie. It exists so that a test can show that the other backends are needed.
#include <epoxy/gl.h>

#include <memory>
#include <utility>

#include "timeline/backends.hpp"
#include "timeline/cpu_wait.hpp"

namespace sluice::host {

namespace {

class UnsynchronisedTimeline final : public HostTimeline {
  public:
    explicit UnsynchronisedTimeline(TimelineDeps deps) : deps_(std::move(deps)) {}

    [[nodiscard]] SluiceTimelineKind kind() const override { return SLUICE_TIMELINE_UNSYNCHRONISED; }

    [[nodiscard]] Status signal(std::uint64_t value, std::span<const std::uint32_t> /*textures*/) override {
        glFlush();
        return signalFromCpu(deps_, value, SLUICE_TRACK_HOST_CPU);
    }

    [[nodiscard]] Status wait(std::uint64_t /*value*/, std::uint64_t /*timeout_ns*/,
                              std::span<const std::uint32_t> /*textures*/) override {
        return {};
    }

  private:
    TimelineDeps deps_;
};

}  // namespace

std::unique_ptr<HostTimeline> makeUnsynchronisedTimeline(const TimelineDeps& deps) {
    return std::make_unique<UnsynchronisedTimeline>(deps);
}

}  // namespace sluice::host
