// SPDX-License-Identifier: MIT
// HOST_DEPTH into a buffer that a simulation's fluid collides with.
#pragma once

#include "passes/context.hpp"
#include "passes/pipeline.hpp"

namespace sluice::vk {

/// The view of a frame's camera, as the solver wants it.
[[nodiscard]] Status checkCamera(const SluiceCamera& camera);
/// Bytes of the buffer for pictures of that size.
[[nodiscard]] VkDeviceSize captureBytes(std::uint32_t width, std::uint32_t height, std::uint32_t scale);

struct CaptureDepthPass {
    static Result<CaptureDepthPass> create(const Device& device);
    void record(const PassContext& context, const DepthCapture& capture) const;
    Pipeline pipeline;
};

}  // namespace sluice::vk
