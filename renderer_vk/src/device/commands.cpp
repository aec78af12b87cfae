// SPDX-License-Identifier: MIT
#include "device/commands.hpp"

#include "device/structs.hpp"

namespace sluice::vk {

Status createCommands(const Device& device, VkCommandPool& pool, VkCommandBuffer& commands) {
    auto pool_info = vkStruct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool_info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool_info.queueFamilyIndex = device.queue_family;
    VkResult result = device.fn.vkCreateCommandPool(device.handle, &pool_info, nullptr, &pool);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "vkCreateCommandPool");
    }
    auto info = vkStruct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool = pool;
    info.commandBufferCount = 1;
    result = device.fn.vkAllocateCommandBuffers(device.handle, &info, &commands);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "vkAllocateCommandBuffers");
    }
    return {};
}

void memoryBarrier(const Device& device, VkCommandBuffer commands, VkPipelineStageFlags2 from, VkAccessFlags2 written,
                   VkPipelineStageFlags2 to, VkAccessFlags2 used) {
    auto barrier = vkStruct<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
    barrier.srcStageMask = from;
    barrier.srcAccessMask = written;
    barrier.dstStageMask = to;
    barrier.dstAccessMask = used;
    auto dependency = vkStruct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    device.fn.vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace sluice::vk
