// SPDX-License-Identifier: MIT
// A buffer with its own memory, mapped for its whole life when the host can see it.
#pragma once

#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "device/device.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

enum class BufferPlace : std::uint8_t {
    Device,   ///< device-local; filled by a copy
    Upload,   ///< host-visible and coherent, device-local where possible; mapped
    Readback  ///< host-visible and coherent, cached where possible; mapped
};

struct BufferDesc {
    VkDeviceSize size = 0;  ///< bytes, > 0
    VkBufferUsageFlags usage = 0;
    BufferPlace place = BufferPlace::Device;
    const char* name = "";
    bool both_queues = false;  ///< used on the device's queue and on that of its computeView()
};

/// Move-only; must die before its Device, and only when no submitted work uses it.
class Buffer {
  public:
    static Result<Buffer> create(const Device& device, const BufferDesc& desc);

    Buffer() = default;
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;
    ~Buffer();

    [[nodiscard]] VkBuffer buffer() const { return buffer_; }
    [[nodiscard]] VkDeviceSize size() const { return size_; }
    /// The bytes of a mapped buffer; empty for BufferPlace::Device. Coherent: no flush is needed.
    [[nodiscard]] std::span<std::byte> mapped() const { return mapped_; }
    [[nodiscard]] explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }

  private:
    void reset();

    const Device* device_ = nullptr;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkDeviceSize size_ = 0;
    std::span<std::byte> mapped_{};
};

}  // namespace sluice::vk
