// SPDX-License-Identifier: MIT
#include "device/capabilities.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include "device/structs.hpp"
#include "memory/image.hpp"
#include "sluice/capability_words.hpp"
#include "sluice/format.hpp"

namespace sluice::vk {
namespace {

template <std::size_t N>
void copyText(char (&to)[N], const char* from) {
    const std::size_t length = std::min(std::strlen(from), N - 1);
    std::memcpy(to, from, length);
    to[length] = '\0';
}

bool exportsSemaphore(const InstanceFunctions& fn, VkPhysicalDevice device, VkSemaphoreType type) {
    auto kind = vkStruct<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
    kind.semaphoreType = type;
    auto info =
        vkStruct<VkPhysicalDeviceExternalSemaphoreInfo>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_SEMAPHORE_INFO);
    info.pNext = &kind;
    info.handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT;
    auto found = vkStruct<VkExternalSemaphoreProperties>(VK_STRUCTURE_TYPE_EXTERNAL_SEMAPHORE_PROPERTIES);
    fn.vkGetPhysicalDeviceExternalSemaphoreProperties(device, &info, &found);
    return (found.externalSemaphoreFeatures & VK_EXTERNAL_SEMAPHORE_FEATURE_EXPORTABLE_BIT) != 0;
}

VkFormatFeatureFlags optimalFeatures(const InstanceFunctions& fn, VkPhysicalDevice device, VkFormat format) {
    auto found = vkStruct<VkFormatProperties2>(VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_2);
    fn.vkGetPhysicalDeviceFormatProperties2(device, format, &found);
    return found.formatProperties.optimalTilingFeatures;
}

/// Export features of an image of this format and usage; 0 if such an image cannot be made at all.
VkExternalMemoryFeatureFlags exportFeatures(const InstanceFunctions& fn, VkPhysicalDevice device, VkFormat format,
                                            VkImageUsageFlags usage) {
    auto external =
        vkStruct<VkPhysicalDeviceExternalImageFormatInfo>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_IMAGE_FORMAT_INFO);
    external.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    auto info = vkStruct<VkPhysicalDeviceImageFormatInfo2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_FORMAT_INFO_2);
    info.pNext = &external;
    info.format = format;
    info.type = VK_IMAGE_TYPE_2D;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = usage;
    info.flags = sharedFlags(format);
    auto memory = vkStruct<VkExternalImageFormatProperties>(VK_STRUCTURE_TYPE_EXTERNAL_IMAGE_FORMAT_PROPERTIES);
    auto found = vkStruct<VkImageFormatProperties2>(VK_STRUCTURE_TYPE_IMAGE_FORMAT_PROPERTIES_2);
    found.pNext = &memory;
    if (fn.vkGetPhysicalDeviceImageFormatProperties2(device, &info, &found) != VK_SUCCESS) {
        return 0;
    }
    return memory.externalMemoryProperties.externalMemoryFeatures;
}

void queryFormats(const InstanceFunctions& fn, VkPhysicalDevice device, SluiceRendererCapabilities& out) {
    for (const FormatInfo& row : formatTable()) {
        const auto format = static_cast<VkFormat>(row.vk_format);
        const VkFormatFeatureFlags features = optimalFeatures(fn, device, format);
        if ((features & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) != 0) {
            out.storage_formats |= formatBit(row.format);
        }
        if ((features & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT) != 0) {
            out.blendable_formats |= formatBit(row.format);
        }
        const VkImageUsageFlags usage = sharedUsage(row.format, features);
        constexpr VkImageUsageFlags kNeeded =
            VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        if ((usage & kNeeded) != kNeeded) {
            continue;
        }
        const VkExternalMemoryFeatureFlags exports = exportFeatures(fn, device, format, usage);
        if ((exports & VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT) != 0) {
            out.exportable_formats |= formatBit(row.format);
        }
    }
}

}  // namespace

VkImageUsageFlags sharedUsage(SluiceFormat /*format*/, VkFormatFeatureFlags features) {
    struct Pair {
        VkFormatFeatureFlags feature;
        VkImageUsageFlags usage;
    };
    constexpr Pair kPairs[] = {
        {VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, VK_IMAGE_USAGE_SAMPLED_BIT},
        {VK_FORMAT_FEATURE_TRANSFER_SRC_BIT, VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
        {VK_FORMAT_FEATURE_TRANSFER_DST_BIT, VK_IMAGE_USAGE_TRANSFER_DST_BIT},
        {VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, VK_IMAGE_USAGE_STORAGE_BIT},
        {VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
        {VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT},
    };
    VkImageUsageFlags usage = 0;
    for (const Pair& pair : kPairs) {
        if ((features & pair.feature) != 0) {
            usage |= pair.usage;
        }
    }
    return usage;
}

VkImageUsageFlags sharedUsage(const InstanceFunctions& fn, VkPhysicalDevice device, SluiceFormat format) {
    const FormatInfo* row = findFormat(format);
    if (row == nullptr) {
        return 0;
    }
    return sharedUsage(format, optimalFeatures(fn, device, static_cast<VkFormat>(row->vk_format)));
}

VkImageCreateFlags sharedFlags(VkFormat format) {
    return aspectOf(format) == VK_IMAGE_ASPECT_COLOR_BIT ? VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT : 0;
}

bool hasExtension(const InstanceFunctions& fn, VkPhysicalDevice device, const char* name) {
    std::uint32_t count = 0;
    if (fn.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr) != VK_SUCCESS) {
        return false;
    }
    std::vector<VkExtensionProperties> found(count);
    if (fn.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, found.data()) < VK_SUCCESS) {
        return false;
    }
    found.resize(count);
    return std::any_of(found.begin(), found.end(),
                       [name](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
}

DeviceCandidate queryCandidate(const InstanceFunctions& fn, VkPhysicalDevice device) {
    DeviceCandidate candidate;
    SluiceRendererCapabilities& out = candidate.capabilities;
    out.struct_size = sizeof(out);

    auto driver = vkStruct<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
    auto id = vkStruct<VkPhysicalDeviceIDProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES);
    id.pNext = &driver;
    auto properties = vkStruct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    properties.pNext = &id;
    fn.vkGetPhysicalDeviceProperties2(device, &properties);
    out.api_version = properties.properties.apiVersion;
    std::memcpy(out.device_uuid, id.deviceUUID, SLUICE_UUID_SIZE);
    std::memcpy(out.driver_uuid, id.driverUUID, SLUICE_UUID_SIZE);
    copyText(out.device_name, properties.properties.deviceName);
    out.reserved[kMaxParticlesWord] =
        static_cast<std::uint32_t>(properties.properties.limits.maxStorageBufferRange / kPositionBytes);
    candidate.driver = driver.driverID;
    copyText(out.driver_name, driver.driverName);
    copyText(out.driver_info, driver.driverInfo);
    out.has_external_memory_fd = hasExtension(fn, device, VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME) ? 1 : 0;

    std::uint32_t count = 0;
    fn.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    fn.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    out.queue_families = count;
    for (std::uint32_t i = 0; i < count; ++i) {
        out.queues += families[i].queueCount;
        constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        if (!candidate.queue_family && (families[i].queueFlags & kBoth) == kBoth) {
            candidate.queue_family = i;
        }
    }
    if (out.api_version < VK_API_VERSION_1_3) {
        return candidate;  // the questions below need 1.3, and the device will be refused for this anyway
    }

    auto v13 = vkStruct<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
    auto v12 = vkStruct<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    v12.pNext = &v13;
    auto features = vkStruct<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
    features.pNext = &v12;
    fn.vkGetPhysicalDeviceFeatures2(device, &features);
    out.has_timeline_semaphore = v12.timelineSemaphore != VK_FALSE ? 1 : 0;
    candidate.synchronization2 = v13.synchronization2 != VK_FALSE;
    candidate.dynamic_rendering = v13.dynamicRendering != VK_FALSE;
    candidate.maintenance4 = v13.maintenance4 != VK_FALSE;

    if (hasExtension(fn, device, VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME)) {
        out.exports_timeline_fd = exportsSemaphore(fn, device, VK_SEMAPHORE_TYPE_TIMELINE) ? 1 : 0;
        out.exports_binary_fd = exportsSemaphore(fn, device, VK_SEMAPHORE_TYPE_BINARY) ? 1 : 0;
    }
    queryFormats(fn, device, out);
    return candidate;
}

}  // namespace sluice::vk
