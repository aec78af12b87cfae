// SPDX-License-Identifier: MIT
// What a physical device can do, asked once.
#pragma once

#include <volk.h>

#include <cstdint>

#include "device/functions.hpp"
#include "device/select.hpp"
#include "sluice/plugin.h"

namespace sluice::vk {

/// Of one particle in the buffer that the passes bind: x, y, z.
inline constexpr std::uint64_t kPositionBytes = 3 * sizeof(float);

/// Usage of a shared image of `format`: all that either side may do with it and the device supports, because OpenGL
/// assumes that the image was made for everything it can do (GL_EXT_external_objects, issue 13).
[[nodiscard]] VkImageUsageFlags sharedUsage(SluiceFormat format, VkFormatFeatureFlags features);
/// sharedUsage with the features looked up.
[[nodiscard]] VkImageUsageFlags sharedUsage(const InstanceFunctions& fn, VkPhysicalDevice device, SluiceFormat format);

/// Flags of a shared image: MUTABLE_FORMAT for colour, because GL >= 4.3 may make texture views of it (issue 17).
[[nodiscard]] VkImageCreateFlags sharedFlags(VkFormat format);

/// Everything about one device that the choice and the agreement need.
[[nodiscard]] DeviceCandidate queryCandidate(const InstanceFunctions& fn, VkPhysicalDevice device);

/// True if the device offers this extension.
[[nodiscard]] bool hasExtension(const InstanceFunctions& fn, VkPhysicalDevice device, const char* name);

}  // namespace sluice::vk
