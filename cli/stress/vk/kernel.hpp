// SPDX-License-Identifier: MIT
// The pipeline that computes a turn: a triangle into an image, or a dispatch over a buffer.
#pragma once

#include <volk.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>

#include "device/device.hpp"
#include "passes/pipeline.hpp"
#include "sluice/result.hpp"
#include "stress/slots.hpp"

namespace sluice::stress {

/// What a slot is to Vulkan; the view or the buffer is null.
struct SlotRef {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkBuffer buffer = VK_NULL_HANDLE;
};

/// The turn's own numbers; cli/stress/chain.hpp.
struct TurnConstants {
    std::uint32_t salt = 0, inputs = 0, width = 0, texels = 0;
};

/// One kind of resource. Pinned; dies before its device, with no work left that uses it.
class Kernel {
  public:
    [[nodiscard]] static Result<std::unique_ptr<Kernel>> create(const vk::Device& device, const Storage& storage);
    explicit Kernel(const vk::Device& device) : device_(device) {}
    Kernel(const Kernel&) = delete;
    Kernel& operator=(const Kernel&) = delete;
    ~Kernel();

    /// The turn itself, without any barrier. Images are in layout GENERAL.
    [[nodiscard]] Status record(VkCommandBuffer commands, const std::array<SlotRef, kMaxInputs>& inputs,
                                const SlotRef& output, const TurnConstants& constants);

  private:
    using Key = std::array<std::uint64_t, kMaxInputs + 1>;
    [[nodiscard]] Status createPool();
    [[nodiscard]] Status createPipeline();
    [[nodiscard]] Status createImagePipeline(std::span<const std::uint32_t> constants);
    [[nodiscard]] Result<VkDescriptorSet> setFor(const std::array<SlotRef, kMaxInputs>& inputs, const SlotRef& output);
    [[nodiscard]] bool isBuffer() const { return storage_.resource == Resource::Buffer; }
    [[nodiscard]] VkDescriptorType descriptorType() const {
        return isBuffer() ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    }
    /// The inputs, and of a buffer the output.
    [[nodiscard]] std::uint32_t bindings() const { return kMaxInputs + (isBuffer() ? 1 : 0); }

    const vk::Device& device_;
    Storage storage_;
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    vk::Pipeline pipeline_;
    std::map<Key, VkDescriptorSet> sets_;
};

/// The Vulkan format of an image resource.
[[nodiscard]] VkFormat formatOf(Resource resource);

}  // namespace sluice::stress
