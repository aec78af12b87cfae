// SPDX-License-Identifier: MIT
// Where the validation layer's messages go: counted, and told to the host.
#pragma once

#include <volk.h>

#include <atomic>
#include <cstdint>

#include "device/functions.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Pinned: Vulkan keeps a pointer to it. Any thread may deliver.
struct MessageSink {
    std::atomic<std::uint32_t> count{0};
    std::atomic<const SluiceHostServices*> services{nullptr};  ///< may be null
};

inline constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

/// Fails, naming the package, when the layer or what it must offer is not installed.
[[nodiscard]] Status checkValidationLayer(PFN_vkEnumerateInstanceLayerProperties layers,
                                          PFN_vkEnumerateInstanceExtensionProperties extensions);

/// Warnings and errors, of every message type, to `sink`.
[[nodiscard]] VkDebugUtilsMessengerCreateInfoEXT messengerInfo(MessageSink& sink);

/// Cuts `message` into one line and hands it to the host's log. Null services are ignored.
void logLine(const SluiceHostServices* services, SluiceLogLevel level, std::string_view message);

}  // namespace sluice::vk
