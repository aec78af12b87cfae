// SPDX-License-Identifier: MIT
#include "memory/buffer.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "device/structs.hpp"

namespace sluice::vk {
namespace {

struct MemoryWish {
    VkMemoryPropertyFlags wanted, preferred;
};

MemoryWish wishFor(BufferPlace place) {
    constexpr VkMemoryPropertyFlags kCoherent =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    switch (place) {
        case BufferPlace::Upload:
            return {kCoherent, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT};
        case BufferPlace::Readback:
            return {kCoherent, VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
        case BufferPlace::Device:
            break;
    }
    return {0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT};
}

}  // namespace

Result<Buffer> Buffer::create(const Device& device, const BufferDesc& desc) {
    Buffer out;
    out.device_ = &device;
    out.size_ = desc.size;
    auto info = vkStruct<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = desc.size;
    info.usage = desc.usage;
    const std::vector<std::uint32_t> families =
        desc.both_queues ? device.sharingFamilies() : std::vector<std::uint32_t>{};
    if (!families.empty()) {
        info.sharingMode = VK_SHARING_MODE_CONCURRENT;
        info.queueFamilyIndexCount = static_cast<std::uint32_t>(families.size());
        info.pQueueFamilyIndices = families.data();
    }
    const std::string label = fmt::format("buffer '{}' of {} bytes", desc.name, desc.size);
    if (const VkResult result = device.fn.vkCreateBuffer(device.handle, &info, nullptr, &out.buffer_);
        result != VK_SUCCESS) {
        return vulkanError(result, label);
    }
    device.name(VK_OBJECT_TYPE_BUFFER, out.buffer_, desc.name);
    VkMemoryRequirements needs{};
    device.fn.vkGetBufferMemoryRequirements(device.handle, out.buffer_, &needs);
    const MemoryWish wish = wishFor(desc.place);
    Result<std::uint32_t> type = device.memoryType(needs.memoryTypeBits, wish.wanted, wish.preferred);
    if (!type) {
        return type.error();
    }
    auto allocation = vkStruct<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = type.value();
    if (const VkResult result = device.fn.vkAllocateMemory(device.handle, &allocation, nullptr, &out.memory_);
        result != VK_SUCCESS) {
        return vulkanError(result, "memory of " + label);
    }
    if (const VkResult result = device.fn.vkBindBufferMemory(device.handle, out.buffer_, out.memory_, 0);
        result != VK_SUCCESS) {
        return vulkanError(result, label);
    }
    if (desc.place != BufferPlace::Device) {
        void* address = nullptr;
        if (const VkResult result = device.fn.vkMapMemory(device.handle, out.memory_, 0, VK_WHOLE_SIZE, 0, &address);
            result != VK_SUCCESS) {
            return vulkanError(result, "mapping of " + label);
        }
        out.mapped_ = {static_cast<std::byte*>(address), static_cast<std::size_t>(desc.size)};
    }
    return out;
}

Buffer::Buffer(Buffer&& other) noexcept {
    *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    if (this != &other) {
        reset();
        device_ = std::exchange(other.device_, nullptr);
        buffer_ = std::exchange(other.buffer_, VK_NULL_HANDLE);
        memory_ = std::exchange(other.memory_, VK_NULL_HANDLE);
        size_ = std::exchange(other.size_, 0);
        mapped_ = std::exchange(other.mapped_, {});
    }
    return *this;
}

Buffer::~Buffer() {
    reset();
}

void Buffer::reset() {
    if (device_ == nullptr) {
        return;
    }
    device_->fn.vkDestroyBuffer(device_->handle, buffer_, nullptr);
    device_->fn.vkFreeMemory(device_->handle, memory_, nullptr);  // unmaps
    device_ = nullptr;
    buffer_ = VK_NULL_HANDLE;
    memory_ = VK_NULL_HANDLE;
    mapped_ = {};
}

}  // namespace sluice::vk
