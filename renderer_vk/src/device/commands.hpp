// SPDX-License-Identifier: MIT
// Command buffers, and the barrier that orders what is recorded in them.
#pragma once

#include <volk.h>

#include "device/device.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// A transient pool with one primary command buffer, which goes with the pool. What was made before a failure is left
/// in the arguments, for their owner to destroy.
[[nodiscard]] Status createCommands(const Device& device, VkCommandPool& pool, VkCommandBuffer& commands);

/// What `from` has `written` is there for what `to` has `used`, in all memory.
void memoryBarrier(const Device& device, VkCommandBuffer commands, VkPipelineStageFlags2 from, VkAccessFlags2 written,
                   VkPipelineStageFlags2 to, VkAccessFlags2 used);

}  // namespace sluice::vk
