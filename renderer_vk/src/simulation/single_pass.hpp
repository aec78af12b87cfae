// SPDX-License-Identifier: MIT
// A pass of its own: one pipeline with one descriptor set, which is pointed at its buffers anew for each use.
#pragma once

#include <volk.h>

#include <cstdint>
#include <span>
#include <vector>

#include "passes/pipeline.hpp"

namespace sluice::vk {

/// What a binding of that number is; a texel view for UNIFORM_TEXEL_BUFFER, else a buffer.
struct PassBinding {
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkBufferView texels = VK_NULL_HANDLE;
};

/// Move-only; dies before its device, when no submitted work uses it.
class SinglePass {
  public:
    static Result<SinglePass> create(const Device& device, const ComputeDesc& desc);
    SinglePass() = default;
    SinglePass(SinglePass&& other) noexcept;
    SinglePass& operator=(SinglePass&& other) noexcept;
    SinglePass(const SinglePass&) = delete;
    SinglePass& operator=(const SinglePass&) = delete;
    ~SinglePass();

    /// Points the set at these, in the order and of the types of create. No submitted work may use it.
    void bind(std::span<const PassBinding> bindings) const;
    /// One dispatch of so many workgroups; `push` has the size of create.
    void dispatch(VkCommandBuffer commands, std::span<const std::byte> push, std::uint32_t groups) const;
    [[nodiscard]] explicit operator bool() const { return pool_ != VK_NULL_HANDLE; }

  private:
    const Device* device_ = nullptr;
    Pipeline pipeline_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

/// Builds a pass at its first use.
[[nodiscard]] Status buildOnce(const Device& device, SinglePass& pass, const ComputeDesc& desc);

}  // namespace sluice::vk
