// SPDX-License-Identifier: MIT
// Zeroed Vulkan structs with their type set.
#pragma once

#include <volk.h>

namespace sluice::vk {

/// `auto info = vkStruct<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);`
template <typename T>
[[nodiscard]] T vkStruct(VkStructureType type) {
    T value{};
    value.sType = type;
    return value;
}

}  // namespace sluice::vk
