// SPDX-License-Identifier: MIT
// All passes of a frame, recorded in the order of the plan. The only header of passes/ that frame/ includes.
#pragma once

#include <memory>

#include "device/device.hpp"
#include "frame/pass_context.hpp"
#include "memory/image.hpp"
#include "plan/plan.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Move-only; must die before its Device, and only when no submitted work uses it. Used on the renderer's thread.
class FluidRecorder {
  public:
    static Result<FluidRecorder> create(const Device& device);

    FluidRecorder(FluidRecorder&& other) noexcept;
    FluidRecorder& operator=(FluidRecorder&& other) noexcept;
    FluidRecorder(const FluidRecorder&) = delete;
    FluidRecorder& operator=(const FluidRecorder&) = delete;
    ~FluidRecorder();

    /// Allocates images and builds pipelines that the plan needs and the recorder lacks, and frees images that it no
    /// longer needs; waits for the device only if it has to free something. On failure the recorder keeps what it had.
    Status prepare(const Plan& plan);
    /// Uploads an environment map; null removes it. Waits for the device.
    Status setEnvironment(const SluiceEnvironment* environment);
    /// Records every pass of `plan`, which was the argument of the last successful prepare. The caller guarantees that
    /// the last recording for frame.image_set has finished on the device. Shared images are visible to fragment and
    /// compute shaders in GENERAL and are left so; their last writes are by compute.
    /// On failure the commands must not be submitted.
    [[nodiscard]] Status record(VkCommandBuffer commands, const SluiceFrame& frame, const Plan& plan,
                                const FrameTargets& targets, const ParticleBuffers& particles, PassTimer& timer,
                                const DepthCapture& capture = {});
    /// One of the renderer's own images, in GENERAL once recorded work has finished, for tests and captures; null if
    /// the plan has none. Valid until the next prepare.
    [[nodiscard]] const Image* image(PlanImage id) const;

  private:
    struct State;
    explicit FluidRecorder(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace sluice::vk
