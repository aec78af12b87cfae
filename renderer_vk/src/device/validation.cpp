// SPDX-License-Identifier: MIT
#include "device/validation.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "device/structs.hpp"

namespace sluice::vk {
namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL deliver(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                       VkDebugUtilsMessageTypeFlagsEXT /*types*/,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& sink = *static_cast<MessageSink*>(user);
    sink.count.fetch_add(1, std::memory_order_relaxed);
    const bool error = severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    try {
        logLine(sink.services, error ? SLUICE_LOG_ERROR : SLUICE_LOG_WARNING,
                std::string("validation: ") + (data->pMessage != nullptr ? data->pMessage : ""));
    } catch (...) {
        // Out of memory for the text: the count, which is what tests look at, is already right.
        return VK_FALSE;
    }
    return VK_FALSE;
}

}  // namespace

Status checkValidationLayer(PFN_vkEnumerateInstanceLayerProperties layers,
                            PFN_vkEnumerateInstanceExtensionProperties extensions) {
    const Error missing{SLUICE_ERROR_UNSUPPORTED, kValidationLayer, "the layer is not installed",
                        "install the package vulkan-validationlayers, or create the renderer without validation"};
    std::uint32_t count = 0;
    if (layers(&count, nullptr) != VK_SUCCESS) {
        return missing;
    }
    std::vector<VkLayerProperties> found(count);
    if (layers(&count, found.data()) < VK_SUCCESS) {
        return missing;
    }
    found.resize(count);
    if (std::none_of(found.begin(), found.end(), [](const VkLayerProperties& layer) {
            return std::strcmp(layer.layerName, kValidationLayer) == 0;
        })) {
        return missing;
    }
    std::uint32_t extension_count = 0;
    if (extensions(kValidationLayer, &extension_count, nullptr) != VK_SUCCESS) {
        return missing;
    }
    std::vector<VkExtensionProperties> offered(extension_count);
    if (extensions(kValidationLayer, &extension_count, offered.data()) < VK_SUCCESS) {
        return missing;
    }
    offered.resize(extension_count);
    for (const char* wanted : {VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME, VK_EXT_DEBUG_UTILS_EXTENSION_NAME}) {
        if (std::none_of(offered.begin(), offered.end(), [wanted](const VkExtensionProperties& extension) {
                return std::strcmp(extension.extensionName, wanted) == 0;
            })) {
            return Error{SLUICE_ERROR_UNSUPPORTED, kValidationLayer, std::string("it lacks ") + wanted,
                         "install a newer vulkan-validationlayers"};
        }
    }
    return {};
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(MessageSink& sink) {
    auto info = vkStruct<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = deliver;
    info.pUserData = &sink;
    return info;
}

void logLine(const SluiceHostServices* services, SluiceLogLevel level, std::string_view message) {
    if (services == nullptr || services->log == nullptr) {
        return;
    }
    std::string line(message);
    std::replace(line.begin(), line.end(), '\n', ' ');
    services->log(services->user, level, line.c_str());
}

}  // namespace sluice::vk
