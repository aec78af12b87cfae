// SPDX-License-Identifier: MIT
#include "stress/gl/fence_here.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "timeline/cpu_wait.hpp"

namespace sluice::stress {
namespace {

constexpr std::uint64_t kFenceTimeoutNs = 10'000'000'000;

class FenceHere final : public HostTimeline {
  public:
    explicit FenceHere(host::TimelineDeps deps) : deps_(std::move(deps)) {}

    [[nodiscard]] SluiceTimelineKind kind() const override { return SLUICE_TIMELINE_BRIDGED; }

    [[nodiscard]] Status signal(std::uint64_t value, std::span<const std::uint32_t> /*textures*/) override {
        glFlush();  // for Mesa: see host_gl/src/timeline/bridged.cpp
        const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
        const GLenum result = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, kFenceTimeoutNs);
        glDeleteSync(fence);
        if (result != GL_ALREADY_SIGNALED && result != GL_CONDITION_SATISFIED) {
            return Error{SLUICE_TIMEOUT, "fence on the host's thread",
                         fmt::format("glClientWaitSync for value {} ended with {:#x}", value, result), ""};
        }
        return host::signalFromCpu(deps_, value, SLUICE_TRACK_HOST_CPU);
    }

    [[nodiscard]] Status wait(std::uint64_t value, std::uint64_t timeout_ns,
                              std::span<const std::uint32_t> /*textures*/) override {
        return host::waitOnCpu(deps_, value, timeout_ns, nullptr);
    }

  private:
    host::TimelineDeps deps_;
};

}  // namespace

std::unique_ptr<HostTimeline> makeFenceHere(const host::TimelineDeps& deps) {
    return std::make_unique<FenceHere>(deps);
}

}  // namespace sluice::stress
