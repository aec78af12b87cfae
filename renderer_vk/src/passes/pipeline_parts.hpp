// SPDX-License-Identifier: MIT
// What a pipeline is made from, for whoever makes one of a kind of its own.
#pragma once

#include <volk.h>

#include <cstdint>
#include <span>
#include <vector>

#include "device/device.hpp"
#include "device/structs.hpp"
#include "passes/pipeline.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// A shader module for the length of one pipeline's creation.
class ShaderModule {
  public:
    ShaderModule(const Device& device, std::span<const std::uint32_t> code) : device_(device) {
        auto info = vkStruct<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
        info.codeSize = code.size_bytes();
        info.pCode = code.data();
        result = device.fn.vkCreateShaderModule(device.handle, &info, nullptr, &handle);
    }
    ShaderModule(const ShaderModule&) = delete;
    ShaderModule& operator=(const ShaderModule&) = delete;
    ~ShaderModule() { device_.fn.vkDestroyShaderModule(device_.handle, handle, nullptr); }

    VkShaderModule handle = VK_NULL_HANDLE;
    VkResult result = VK_SUCCESS;

  private:
    const Device& device_;
};

/// Specialisation constants as Vulkan wants them: 32 bits each, ids from 0. The constants must outlive it.
struct Specialisation {
    explicit Specialisation(std::span<const std::uint32_t> constants) {
        for (std::uint32_t id = 0; id < constants.size(); ++id) {
            entries.push_back({id, id * 4U, 4});
        }
        info.mapEntryCount = static_cast<std::uint32_t>(entries.size());
        info.pMapEntries = entries.data();
        info.dataSize = constants.size_bytes();
        info.pData = constants.data();
    }
    Specialisation(const Specialisation&) = delete;
    Specialisation& operator=(const Specialisation&) = delete;
    ~Specialisation() = default;
    std::vector<VkSpecializationMapEntry> entries;
    VkSpecializationInfo info{};
};

/// The layouts of `pipeline`, which has its device: bindings of set 0 from 0 on, one of each type, and push constants.
[[nodiscard]] Status createLayouts(const Device& device, Pipeline& pipeline, std::span<const VkDescriptorType> types,
                                   std::uint32_t push_bytes, VkShaderStageFlags stages, const char* name);

}  // namespace sluice::vk
