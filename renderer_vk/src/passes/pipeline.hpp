// SPDX-License-Identifier: MIT
// A pipeline with the layouts that it was made from. All bindings are in set 0, numbered from 0.
#pragma once

#include <volk.h>

#include <cstdint>
#include <span>

#include "device/device.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Move-only; must die before its Device, and only when no submitted work uses it.
class Pipeline {
  public:
    Pipeline() = default;
    Pipeline(Pipeline&& other) noexcept;
    Pipeline& operator=(Pipeline&& other) noexcept;
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;
    ~Pipeline();

    VkPipeline handle = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    const Device* device = nullptr;  ///< not owned

  private:
    void reset();
};

/// Push constants of every pipeline begin at 0 and are visible to all its stages.
inline constexpr std::uint32_t kMaxPushBytes = 128;

struct ComputeDesc {
    const char* name = "";
    std::span<const std::uint32_t> code;
    std::span<const VkDescriptorType> bindings;
    std::uint32_t push_bytes = 0;
    std::span<const std::uint32_t> constants;  ///< specialisation constants 0, 1, ...
};
[[nodiscard]] Result<Pipeline> createCompute(const Device& device, const ComputeDesc& desc);

struct SplatDesc {
    const char* name = "";
    std::span<const std::uint32_t> vertex, fragment;
    std::span<const VkDescriptorType> bindings;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    std::span<const VkFormat> targets;
    VkBlendOp blend = VK_BLEND_OP_ADD;           ///< of source and destination, both with factor one
    std::span<const std::uint32_t> constants{};  ///< specialisation constants 0, 1, ... of both stages
};
/// Without vertex input, no depth test, no culling; viewport and scissor are dynamic.
[[nodiscard]] Result<Pipeline> createSplat(const Device& device, const SplatDesc& desc);

}  // namespace sluice::vk
