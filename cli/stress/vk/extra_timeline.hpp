// SPDX-License-Identifier: MIT
// A timeline semaphore that only the CPU signals and waits for.
#pragma once

#include <volk.h>

#include <cstdint>

#include "device/device.hpp"
#include "device/structs.hpp"
#include "sluice/result.hpp"

namespace sluice::stress {

/// A timeline that the renderer's own code knows nothing of.
class ExtraTimeline {
  public:
    explicit ExtraTimeline(const vk::Device& device, VkSemaphore semaphore) : device_(device), semaphore_(semaphore) {}
    ExtraTimeline(const ExtraTimeline&) = delete;
    ExtraTimeline& operator=(const ExtraTimeline&) = delete;
    ~ExtraTimeline() { device_.fn.vkDestroySemaphore(device_.handle, semaphore_, nullptr); }

    [[nodiscard]] Status signal(std::uint64_t value) const {
        auto info = vk::vkStruct<VkSemaphoreSignalInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO);
        info.semaphore = semaphore_;
        info.value = value;
        const VkResult result = device_.fn.vkSignalSemaphore(device_.handle, &info);
        return result == VK_SUCCESS ? Status{} : Status{vk::vulkanError(result, "vkSignalSemaphore of the relay")};
    }
    [[nodiscard]] SluiceResult wait(std::uint64_t value, std::uint64_t timeout_ns) const {
        auto info = vk::vkStruct<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
        info.semaphoreCount = 1;
        info.pSemaphores = &semaphore_;
        info.pValues = &value;
        const VkResult result = device_.fn.vkWaitSemaphores(device_.handle, &info, timeout_ns);
        return result == VK_SUCCESS   ? SLUICE_OK
               : result == VK_TIMEOUT ? SLUICE_TIMEOUT
                                      : vk::vulkanError(result, "vkWaitSemaphores of the relay").code;
    }

  private:
    const vk::Device& device_;
    VkSemaphore semaphore_;
};

}  // namespace sluice::stress
