// SPDX-License-Identifier: MIT
// The memory of the Vulkan side's slots: images or buffers, and how they change hands.
#pragma once

#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "device/device.hpp"
#include "memory/image.hpp"
#include "sluice/result.hpp"
#include "stress/slots.hpp"
#include "stress/vk/kernel.hpp"
#include "stress/vk/shared_buffer.hpp"

namespace sluice::stress {

/// Pinned; dies before its device, with no work left that uses it.
class SlotMemory {
  public:
    /// Images are in layout GENERAL, and all shared slots given to OpenGL.
    [[nodiscard]] static Result<std::unique_ptr<SlotMemory>> create(const vk::Device& device, const Storage& storage);
    SlotMemory(const vk::Device& device, const Storage& storage) : device_(device), storage_(storage) {}
    SlotMemory(const SlotMemory&) = delete;
    SlotMemory& operator=(const SlotMemory&) = delete;
    ~SlotMemory() = default;

    [[nodiscard]] SlotRef ref(std::uint32_t slot) const;
    [[nodiscard]] Result<ExportedSlot> exportSlot(std::uint32_t slot) const;
    /// Records barriers: between the two APIs for shared slots, within the queue for the side's own.
    void transfer(VkCommandBuffer commands, std::span<const std::uint32_t> slots, bool acquire,
                  std::uint32_t wrong_layout = kNoSlot) const;
    /// Texels of a slot; nothing may use it meanwhile.
    [[nodiscard]] Result<std::vector<std::byte>> read(std::uint32_t slot) const;

  private:
    [[nodiscard]] bool isBuffer() const { return storage_.resource == Resource::Buffer; }
    [[nodiscard]] Status createImages();
    [[nodiscard]] Status createBuffers();

    const vk::Device& device_;
    Storage storage_;
    std::vector<vk::Image> images_;                       // by slot, unless the resource is a buffer
    std::vector<std::unique_ptr<SharedBuffer>> buffers_;  // by slot, if it is
};

}  // namespace sluice::stress
