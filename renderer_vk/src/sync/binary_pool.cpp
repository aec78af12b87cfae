// SPDX-License-Identifier: MIT
#include "sync/binary_pool.hpp"

#include "device/exported_fd.hpp"
#include "device/structs.hpp"

namespace sluice::vk {

Result<VkSemaphore> createSemaphore(const Device& device, VkSemaphoreType type, bool exportable, const char* name) {
    auto exported = vkStruct<VkExportSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO);
    exported.handleTypes = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT;
    auto kind = vkStruct<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
    kind.semaphoreType = type;
    kind.pNext = exportable ? &exported : nullptr;
    auto info = vkStruct<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
    info.pNext = &kind;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    if (const VkResult result = device.fn.vkCreateSemaphore(device.handle, &info, nullptr, &semaphore);
        result != VK_SUCCESS) {
        return vulkanError(result, "vkCreateSemaphore");
    }
    device.name(VK_OBJECT_TYPE_SEMAPHORE, semaphore, name);
    return semaphore;
}

Result<UniqueFd> exportSemaphore(const Device& device, VkSemaphore semaphore) {
    auto info = vkStruct<VkSemaphoreGetFdInfoKHR>(VK_STRUCTURE_TYPE_SEMAPHORE_GET_FD_INFO_KHR);
    info.semaphore = semaphore;
    info.handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT;
    int fd = -1;
    const VkResult result = device.fn.vkGetSemaphoreFdKHR(device.handle, &info, &fd);
    return exportedFd(result, fd, "vkGetSemaphoreFdKHR");
}

BinaryPool::~BinaryPool() {
    retireThrough(UINT64_MAX);
}

VkSemaphore BinaryPool::find(std::uint64_t value) const {
    const auto found = semaphores_.find(value);
    return found == semaphores_.end() ? VK_NULL_HANDLE : found->second;
}

Result<VkSemaphore> BinaryPool::obtain(std::uint64_t value) {
    if (VkSemaphore known = find(value); known != VK_NULL_HANDLE) {
        return known;
    }
    Result<VkSemaphore> made = createSemaphore(device_, VK_SEMAPHORE_TYPE_BINARY, true, "binary hand-off");
    if (made) {
        semaphores_.emplace(value, made.value());
    }
    return made;
}

Result<UniqueFd> BinaryPool::exportFd(std::uint64_t value) {
    Result<VkSemaphore> semaphore = obtain(value);
    if (!semaphore) {
        return semaphore.error();
    }
    return exportSemaphore(device_, semaphore.value());
}

void BinaryPool::retireThrough(std::uint64_t value) {
    const auto end = semaphores_.upper_bound(value);
    for (auto it = semaphores_.begin(); it != end; ++it) {
        device_.fn.vkDestroySemaphore(device_.handle, it->second, nullptr);
    }
    semaphores_.erase(semaphores_.begin(), end);
}

}  // namespace sluice::vk
