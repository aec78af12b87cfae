// SPDX-License-Identifier: MIT
#include "stress/vk/slot_memory.hpp"

#include <utility>

#include "device/capabilities.hpp"
#include "device/commands.hpp"
#include "device/one_shot.hpp"
#include "device/structs.hpp"
#include "memory/buffer.hpp"

namespace sluice::stress {

using vk::vkStruct;

namespace {

SluiceFormat sharedFormat(Resource resource) {
    return resource == Resource::Colour ? SLUICE_FORMAT_RGBA8
           : resource == Resource::D32F ? SLUICE_FORMAT_D32F
                                        : SLUICE_FORMAT_R32F;
}

}  // namespace

Result<std::unique_ptr<SlotMemory>> SlotMemory::create(const vk::Device& device, const Storage& storage) {
    auto memory = std::make_unique<SlotMemory>(device, storage);
    if (Status status = memory->isBuffer() ? memory->createBuffers() : memory->createImages(); !status) {
        return status.error();
    }
    return memory;
}

Status SlotMemory::createBuffers() {
    for (std::uint32_t slot = 0; slot < storage_.slots.count(); ++slot) {
        auto buffer =
            SharedBuffer::create(device_, VkDeviceSize{storage_.texels()} * 4, slot < storage_.slots.shared());
        if (!buffer) {
            return buffer.error();
        }
        buffers_.push_back(std::move(buffer).value());
    }
    return {};
}

Status SlotMemory::createImages() {
    const VkImageUsageFlags usage =
        vk::sharedUsage(device_.instance_fn, device_.physical, sharedFormat(storage_.resource));
    std::vector<std::uint32_t> all;
    for (std::uint32_t slot = 0; slot < storage_.slots.count(); ++slot) {
        auto image = vk::Image::create(device_, {formatOf(storage_.resource), storage_.width, storage_.height, usage,
                                                 slot < storage_.slots.shared(), "stress slot"});
        if (!image) {
            return image.error();
        }
        images_.push_back(std::move(image).value());
        all.push_back(slot);
    }
    return vk::runOnce(device_, [&](VkCommandBuffer commands) {
        for (const vk::Image& image : images_) {
            vk::fullBarrier(device_, commands, image.image(), image.aspect(), VK_IMAGE_LAYOUT_UNDEFINED,
                            VK_IMAGE_LAYOUT_GENERAL);
        }
        transfer(commands, all, false);
    });
}

SlotRef SlotMemory::ref(std::uint32_t slot) const {
    return isBuffer() ? SlotRef{VK_NULL_HANDLE, VK_NULL_HANDLE, buffers_[slot]->buffer()}
                      : SlotRef{images_[slot].image(), images_[slot].view(), VK_NULL_HANDLE};
}

Result<ExportedSlot> SlotMemory::exportSlot(std::uint32_t slot) const {
    auto fd = isBuffer() ? buffers_[slot]->exportFd() : images_[slot].exportFd();
    if (!fd) {
        return fd.error();
    }
    return ExportedSlot{std::move(fd).value(),
                        isBuffer() ? buffers_[slot]->allocationSize() : images_[slot].allocationSize()};
}

void SlotMemory::transfer(VkCommandBuffer commands, std::span<const std::uint32_t> slots, bool acquire,
                          std::uint32_t wrong_layout) const {
    for (const std::uint32_t slot : slots) {
        const bool shared = slot < storage_.slots.shared();
        const std::uint32_t external = shared ? VK_QUEUE_FAMILY_EXTERNAL : VK_QUEUE_FAMILY_IGNORED;
        const std::uint32_t here = shared ? device_.queue_family : VK_QUEUE_FAMILY_IGNORED;
        const std::uint32_t from = acquire ? external : here;
        const std::uint32_t to = acquire ? here : external;
        if (!isBuffer()) {
            const auto old = slot == wrong_layout ? static_cast<VkImageLayout>(kWrongLayout) : VK_IMAGE_LAYOUT_GENERAL;
            vk::fullBarrier(device_, commands, images_[slot].image(), images_[slot].aspect(), old,
                            VK_IMAGE_LAYOUT_GENERAL, from, to);
            continue;
        }
        auto barrier = vkStruct<VkBufferMemoryBarrier2>(VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2);
        barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        barrier.srcQueueFamilyIndex = from;
        barrier.dstQueueFamilyIndex = to;
        barrier.buffer = buffers_[slot]->buffer();
        barrier.size = VK_WHOLE_SIZE;
        auto dependency = vkStruct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
        dependency.bufferMemoryBarrierCount = 1;
        dependency.pBufferMemoryBarriers = &barrier;
        device_.fn.vkCmdPipelineBarrier2(commands, &dependency);
    }
}

Result<std::vector<std::byte>> SlotMemory::read(std::uint32_t slot) const {
    const std::size_t bytes = std::size_t{storage_.texels()} * 4;
    if (!isBuffer()) {
        return vk::downloadImage(device_, images_[slot], 4);
    }
    auto staging = vk::Buffer::create(
        device_, {bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::BufferPlace::Readback, "stress read-back"});
    if (!staging) {
        return staging.error();
    }
    Status copied = vk::runOnce(device_, [&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, bytes};
        device_.fn.vkCmdCopyBuffer(commands, buffers_[slot]->buffer(), staging.value().buffer(), 1, &region);
        vk::memoryBarrier(device_, commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                          VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    });
    if (!copied) {
        return copied.error();
    }
    const auto mapped = staging.value().mapped();
    return std::vector<std::byte>(mapped.begin(), mapped.end());
}

}  // namespace sluice::stress
