// SPDX-License-Identifier: MIT
// Record, submit and wait: for uploads, canaries, the simulation's thread and tests. Never inside the frame loop.
#pragma once

#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "device/device.hpp"
#include "memory/image.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Runs what `record` recorded on the device's queue and waits until it has finished. Fails after 60 seconds.
/// `signals`: what the submission signals at its end.
[[nodiscard]] Status runOnce(const Device& device, const std::function<void(VkCommandBuffer)>& record,
                             std::span<const VkSemaphoreSubmitInfo> signals = {});

/// A full barrier on one image: all commands before, all commands after. For set-up and tests, not for passes.
void fullBarrier(const Device& device, VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                 VkImageLayout from, VkImageLayout to, std::uint32_t from_family = VK_QUEUE_FAMILY_IGNORED,
                 std::uint32_t to_family = VK_QUEUE_FAMILY_IGNORED);

/// Fills an image from tightly packed texels through a staging buffer and leaves it in `layout_after`. The contents
/// before are lost. The image needs TRANSFER_DST usage. Depth-stencil formats: depth aspect only.
[[nodiscard]] Status uploadImage(const Device& device, const Image& image, std::span<const std::byte> texels,
                                 VkImageLayout layout_after = VK_IMAGE_LAYOUT_GENERAL);

/// Reads an image that is in `layout`, and stays so, into tightly packed texels. The image needs TRANSFER_SRC usage.
[[nodiscard]] Result<std::vector<std::byte>> downloadImage(const Device& device, const Image& image,
                                                           std::size_t bytes_per_texel,
                                                           VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL);

}  // namespace sluice::vk
