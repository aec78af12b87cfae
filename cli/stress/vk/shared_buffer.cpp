// SPDX-License-Identifier: MIT
#include "stress/vk/shared_buffer.hpp"

#include <fmt/format.h>

#include "device/exported_fd.hpp"
#include "device/structs.hpp"

namespace sluice::stress {

using vk::vkStruct;

namespace {

/// llvmpipe imports a buffer only from memory that is 48 bytes larger (a block of its rasteriser), up to 2026 at least.
constexpr VkDeviceSize kBehind = 64;

}  // namespace

Result<std::unique_ptr<SharedBuffer>> SharedBuffer::create(const vk::Device& device, VkDeviceSize size,
                                                           bool exportable) {
    auto out = std::make_unique<SharedBuffer>(device);
    out->size_ = size;
    auto external = vkStruct<VkExternalMemoryBufferCreateInfo>(VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO);
    external.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    auto info = vkStruct<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = size + kBehind;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    info.pNext = exportable ? &external : nullptr;
    const std::string label = fmt::format("shared buffer of {} bytes", size);
    if (const VkResult result = device.fn.vkCreateBuffer(device.handle, &info, nullptr, &out->buffer_);
        result != VK_SUCCESS) {
        return vk::vulkanError(result, label);
    }
    VkMemoryRequirements needs{};
    device.fn.vkGetBufferMemoryRequirements(device.handle, out->buffer_, &needs);
    Result<std::uint32_t> type = device.memoryType(needs.memoryTypeBits, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    if (!type) {
        return type.error();
    }
    auto dedicated = vkStruct<VkMemoryDedicatedAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO);
    dedicated.buffer = out->buffer_;
    auto exported = vkStruct<VkExportMemoryAllocateInfo>(VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO);
    exported.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    exported.pNext = &dedicated;
    auto allocation = vkStruct<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.allocationSize = out->allocation_size_ = needs.size;
    allocation.memoryTypeIndex = type.value();
    allocation.pNext = exportable ? &exported : nullptr;
    if (const VkResult result = device.fn.vkAllocateMemory(device.handle, &allocation, nullptr, &out->memory_);
        result != VK_SUCCESS) {
        return vk::vulkanError(result, "memory of " + label);
    }
    if (const VkResult result = device.fn.vkBindBufferMemory(device.handle, out->buffer_, out->memory_, 0);
        result != VK_SUCCESS) {
        return vk::vulkanError(result, label);
    }
    return out;
}

SharedBuffer::~SharedBuffer() {
    device_.fn.vkDestroyBuffer(device_.handle, buffer_, nullptr);
    device_.fn.vkFreeMemory(device_.handle, memory_, nullptr);
}

Result<UniqueFd> SharedBuffer::exportFd() const {
    auto info = vkStruct<VkMemoryGetFdInfoKHR>(VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR);
    info.memory = memory_;
    info.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    int fd = -1;
    const VkResult result = device_.fn.vkGetMemoryFdKHR(device_.handle, &info, &fd);
    return vk::exportedFd(result, fd, "vkGetMemoryFdKHR of a shared buffer");
}

}  // namespace sluice::stress
