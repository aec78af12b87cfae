// SPDX-License-Identifier: MIT
// What one image set needs while its commands are in flight: descriptor sets and the frame's constants.
#pragma once

#include <volk.h>

#include <cstddef>
#include <span>

#include "device/device.hpp"
#include "memory/buffer.hpp"
#include "passes/pipeline.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// One resource in binding order; exactly one of buffer and view is set.
struct Binding {
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    VkImageView view = VK_NULL_HANDLE;
    VkBuffer buffer = VK_NULL_HANDLE;
};
[[nodiscard]] inline Binding sampled(VkImageView view) {
    return {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, view, {}};
}
[[nodiscard]] inline Binding storage(VkImageView view) {
    return {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, view, {}};
}
[[nodiscard]] inline Binding uniform(VkBuffer buffer) {
    return {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, {}, buffer};
}
[[nodiscard]] inline Binding readBuffer(VkBuffer buffer) {
    return {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {}, buffer};
}

/// Reset and refilled each time its image set is recorded, which is after that set's previous frame has finished.
class FrameArena {
  public:
    static Result<FrameArena> create(const Device& device, std::size_t constants_bytes);

    FrameArena() = default;
    FrameArena(FrameArena&& other) noexcept;
    FrameArena& operator=(FrameArena&& other) noexcept;
    FrameArena(const FrameArena&) = delete;
    FrameArena& operator=(const FrameArena&) = delete;
    ~FrameArena();

    /// Gives every descriptor set of the last recording back and stores the frame's constants.
    void begin(std::span<const std::byte> constants);
    [[nodiscard]] VkBuffer constants() const { return constants_.buffer(); }
    /// Binds `pipeline` with `bindings` in order. Images are in VK_IMAGE_LAYOUT_GENERAL. A failure is kept for
    /// failure().
    void bind(VkCommandBuffer commands, VkPipelineBindPoint point, const Pipeline& pipeline,
              std::span<const Binding> bindings);

    /// The first failure of a bind since begin(): what was recorded since must not be submitted.
    [[nodiscard]] VkResult failure() const { return failure_; }

  private:
    void reset();

    const Device* device_ = nullptr;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    Buffer constants_;
    VkResult failure_ = VK_SUCCESS;
};

}  // namespace sluice::vk
