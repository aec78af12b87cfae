// SPDX-License-Identifier: MIT
#include "device/one_shot.hpp"

#include <cstring>

#include "device/commands.hpp"
#include "device/structs.hpp"
#include "memory/buffer.hpp"

namespace sluice::vk {
namespace {

constexpr std::uint64_t kDeadlineNs = 60'000'000'000;

/// Destroys what one call needs, in the right order, however the call ends.
struct Transient {
    const Device& device;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;

    explicit Transient(const Device& owner) : device(owner) {}
    Transient(const Transient&) = delete;
    Transient& operator=(const Transient&) = delete;
    ~Transient() {
        device.fn.vkDestroyFence(device.handle, fence, nullptr);
        device.fn.vkDestroyCommandPool(device.handle, pool, nullptr);
    }
};

VkBufferImageCopy wholeImage(const Image& image) {
    VkBufferImageCopy region{};
    region.imageSubresource = {image.aspect() & ~VkImageAspectFlags{VK_IMAGE_ASPECT_STENCIL_BIT}, 0, 0, 1};
    region.imageExtent = {image.width(), image.height(), 1};
    return region;
}

void count(const Device& device, const Image& image, std::size_t bytes) {
    if (image.exportable()) {
        device.shared_bytes_by_cpu.fetch_add(bytes, std::memory_order_relaxed);
    }
}

}  // namespace

Status runOnce(const Device& device, const std::function<void(VkCommandBuffer)>& record,
               std::span<const VkSemaphoreSubmitInfo> signals) {
    Transient mine(device);
    VkCommandBuffer commands = VK_NULL_HANDLE;
    if (Status status = createCommands(device, mine.pool, commands); !status) {
        return status;
    }
    auto fence_info = vkStruct<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    VkResult result = device.fn.vkCreateFence(device.handle, &fence_info, nullptr, &mine.fence);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "vkCreateFence");
    }
    auto begin = vkStruct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    result = device.fn.vkBeginCommandBuffer(commands, &begin);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "vkBeginCommandBuffer");
    }
    record(commands);
    result = device.fn.vkEndCommandBuffer(commands);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "vkEndCommandBuffer");
    }
    auto command_info = vkStruct<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
    command_info.commandBuffer = commands;
    auto submit = vkStruct<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &command_info;
    submit.signalSemaphoreInfoCount = static_cast<std::uint32_t>(signals.size());
    submit.pSignalSemaphoreInfos = signals.data();
    HostPromise behind;
    result = device.submit(submit, mine.fence, {}, &behind);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "vkQueueSubmit2");
    }
    const auto deadline = deadlineIn(kDeadlineNs);
    const bool kept = !behind.of || behind.of->waitUntilKept(behind.value, deadline);
    result = kept ? device.fn.vkWaitForFences(device.handle, 1, &mine.fence, VK_TRUE, leftUntil(deadline)) : VK_TIMEOUT;
    const bool late = result == VK_TIMEOUT;
    if (late) {
        // Freeing what the queue still uses would be worse than waiting on; the queue's lock would stop its other user.
        result = device.fn.vkWaitForFences(device.handle, 1, &mine.fence, VK_TRUE, UINT64_MAX);
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, "vkWaitForFences");
    }
    if (late) {
        return Error{SLUICE_ERROR_INTERNAL, "one-shot commands", "not finished after 60 s", ""};
    }
    return {};
}

void fullBarrier(const Device& device, VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                 VkImageLayout from, VkImageLayout to, std::uint32_t from_family, std::uint32_t to_family) {
    auto barrier = vkStruct<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2);
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = from_family;
    barrier.dstQueueFamilyIndex = to_family;
    barrier.image = image;
    barrier.subresourceRange = {aspect, 0, 1, 0, 1};
    auto dependency = vkStruct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    device.fn.vkCmdPipelineBarrier2(commands, &dependency);
}

Status uploadImage(const Device& device, const Image& image, std::span<const std::byte> texels,
                   VkImageLayout layout_after) {
    Result<Buffer> staging =
        Buffer::create(device, {texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BufferPlace::Upload, "image upload"});
    if (!staging) {
        return staging.error();
    }
    std::memcpy(staging.value().mapped().data(), texels.data(), texels.size());
    count(device, image, texels.size());
    VkBuffer buffer = staging.value().buffer();
    return runOnce(device, [&](VkCommandBuffer commands) {
        fullBarrier(device, commands, image.image(), image.aspect(), VK_IMAGE_LAYOUT_UNDEFINED,
                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        const VkBufferImageCopy region = wholeImage(image);
        device.fn.vkCmdCopyBufferToImage(commands, buffer, image.image(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                                         &region);
        fullBarrier(device, commands, image.image(), image.aspect(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                    layout_after);
    });
}

Result<std::vector<std::byte>> downloadImage(const Device& device, const Image& image, std::size_t bytes_per_texel,
                                             VkImageLayout layout) {
    std::vector<std::byte> texels(std::size_t{image.width()} * image.height() * bytes_per_texel);
    Result<Buffer> staging = Buffer::create(
        device, {texels.size(), VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Readback, "image download"});
    if (!staging) {
        return staging.error();
    }
    VkBuffer buffer = staging.value().buffer();
    Status status = runOnce(device, [&](VkCommandBuffer commands) {
        fullBarrier(device, commands, image.image(), image.aspect(), layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const VkBufferImageCopy region = wholeImage(image);
        device.fn.vkCmdCopyImageToBuffer(commands, image.image(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1,
                                         &region);
        fullBarrier(device, commands, image.image(), image.aspect(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout);
        memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    });
    if (!status) {
        return status.error();
    }
    count(device, image, texels.size());
    std::memcpy(texels.data(), staging.value().mapped().data(), texels.size());
    return texels;
}

}  // namespace sluice::vk
