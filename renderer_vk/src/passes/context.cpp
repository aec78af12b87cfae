// SPDX-License-Identifier: MIT
#include "passes/context.hpp"

#include <vector>

#include "device/commands.hpp"
#include "device/structs.hpp"

namespace sluice::vk {
namespace {

VkImageMemoryBarrier2 barrierOf(const Image& image, VkImageLayout from, VkImageLayout to) {
    auto barrier = vkStruct<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2);
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.image();
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    return barrier;
}

}  // namespace

void openImages(const PassContext& context) {
    std::vector<VkImageMemoryBarrier2> barriers;
    for (const PlannedImage& planned : context.plan.images) {
        const bool drawn = isDrawn(planned.id);
        VkImageMemoryBarrier2 barrier =
            barrierOf(context.images[planned.id], VK_IMAGE_LAYOUT_UNDEFINED,
                      drawn ? VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_GENERAL);
        // The last frame's accesses of these images were all by compute or by the splats.
        barrier.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
                               VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
        barrier.srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
        // Those that are not drawn into are cleared before they are written.
        barrier.dstStageMask = drawn ? VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT : VK_PIPELINE_STAGE_2_CLEAR_BIT;
        barrier.dstAccessMask = drawn ? VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT
                                      : VK_ACCESS_2_TRANSFER_WRITE_BIT;
        barriers.push_back(barrier);
    }
    // nothing_to_write is bound in every frame, so that the frames' last dispatches are ordered among themselves; the
    // tile lists and the indirect draw are reset by copies after the last frame has read them.
    auto memory = vkStruct<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
    memory.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
    memory.srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    memory.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    memory.dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;
    auto dependency = vkStruct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &memory;
    dependency.imageMemoryBarrierCount = static_cast<std::uint32_t>(barriers.size());
    dependency.pImageMemoryBarriers = barriers.data();
    context.device.fn.vkCmdPipelineBarrier2(context.commands, &dependency);
}

void closeAttachment(const PassContext& context, PlanImage id) {
    VkImageMemoryBarrier2 barrier =
        barrierOf(context.images[id], VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    auto dependency = vkStruct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    context.device.fn.vkCmdPipelineBarrier2(context.commands, &dependency);
}

void order(const PassContext& context, VkPipelineStageFlags2 from, VkAccessFlags2 written, VkPipelineStageFlags2 to,
           VkAccessFlags2 used) {
    memoryBarrier(context.device, context.commands, from, written, to, used);
}

void betweenDispatches(const PassContext& context) {
    order(context, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
          VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
          VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
}

void beforeFragments(const PassContext& context) {
    order(context, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
          VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
}

void dispatchTiles(const PassContext& context, const Buffer& tiles) {
    context.device.fn.vkCmdDispatchIndirect(context.commands, tiles.buffer(), 0);
}

void dispatchOver(const PassContext& context, std::uint32_t width, std::uint32_t height, std::uint32_t tile_x,
                  std::uint32_t tile_y) {
    context.device.fn.vkCmdDispatch(context.commands, (width + tile_x - 1) / tile_x, (height + tile_y - 1) / tile_y, 1);
}

}  // namespace sluice::vk
