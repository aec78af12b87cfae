// SPDX-License-Identifier: MIT
// A storage buffer with memory of its own, exportable to OpenGL when asked for.
#pragma once

#include <volk.h>

#include <cstdint>
#include <memory>

#include "device/device.hpp"
#include "sluice/fd.hpp"
#include "sluice/result.hpp"

namespace sluice::stress {

/// Pinned; dies before its device, with no work left that uses it.
class SharedBuffer {
  public:
    [[nodiscard]] static Result<std::unique_ptr<SharedBuffer>> create(const vk::Device& device, VkDeviceSize size,
                                                                      bool exportable);
    explicit SharedBuffer(const vk::Device& device) : device_(device) {}
    SharedBuffer(const SharedBuffer&) = delete;
    SharedBuffer& operator=(const SharedBuffer&) = delete;
    ~SharedBuffer();

    [[nodiscard]] VkBuffer buffer() const { return buffer_; }
    [[nodiscard]] VkDeviceSize size() const { return size_; }
    [[nodiscard]] VkDeviceSize allocationSize() const { return allocation_size_; }
    [[nodiscard]] Result<UniqueFd> exportFd() const;

  private:
    const vk::Device& device_;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkDeviceSize size_ = 0, allocation_size_ = 0;
};

}  // namespace sluice::stress
