// SPDX-License-Identifier: MIT
#include "device/select.hpp"

#include <fmt/format.h>
#include <volk.h>

#include <algorithm>
#include <string>

#include "sluice/negotiate.hpp"
#include "sluice/uuid.hpp"

namespace sluice::vk {
namespace {

std::string describeHost(const SluiceHostCapabilities& host) {
    std::string text = "OpenGL has device";
    const std::uint32_t count = std::min(host.device_uuid_count, SLUICE_MAX_DEVICE_UUIDS);
    if (count == 0) {
        text += " (no UUID)";
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        text += ' ' + uuidText(host.device_uuids[i]);
    }
    return text + ", driver " + uuidText(host.driver_uuid);
}

std::string describeDevice(const SluiceRendererCapabilities& device) {
    // Cut, so that the message keeps both UUIDs within the 512 characters of a SluiceError.
    return fmt::format("Vulkan's '{:.40}' has device {}, driver {}", device.device_name, uuidText(device.device_uuid),
                       uuidText(device.driver_uuid));
}

}  // namespace

std::string_view missingFeature(const DeviceCandidate& candidate) {
    if (candidate.capabilities.api_version < VK_API_VERSION_1_3) {
        return "Vulkan 1.3";
    }
    if (candidate.capabilities.has_external_memory_fd == 0) {
        return VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME;
    }
    if (candidate.capabilities.has_timeline_semaphore == 0) {
        return "timelineSemaphore";
    }
    if (!candidate.synchronization2) {
        return "synchronization2";
    }
    if (!candidate.dynamic_rendering) {
        return "dynamicRendering";
    }
    if (!candidate.maintenance4) {
        return "maintenance4";
    }
    if (!candidate.queue_family) {
        return "a queue family with graphics and compute";
    }
    return {};
}

std::optional<QueueChoice> chooseComputeQueue(std::span<const VkQueueFamilyProperties> families, std::uint32_t main) {
    for (std::uint32_t i = 0; i < families.size(); ++i) {
        const VkQueueFamilyProperties& family = families[i];
        if (i != main && family.queueCount > 0 && (family.queueFlags & VK_QUEUE_COMPUTE_BIT) != 0 &&
            (family.queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) {
            return QueueChoice{i, 0};
        }
    }
    if (main < families.size() && families[main].queueCount > 1) {
        return QueueChoice{main, 1};
    }
    return std::nullopt;
}

Result<std::size_t> selectDevice(std::span<const DeviceCandidate> candidates, const SluiceHostCapabilities* host) {
    if (candidates.empty()) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "Vulkan", "no physical device was found",
                     "install a Vulkan driver, for instance the package mesa-vulkan-drivers"};
    }
    std::string lacking;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (host != nullptr && !sameDevice(*host, candidates[i].capabilities)) {
            continue;
        }
        const std::string_view missing = missingFeature(candidates[i]);
        if (missing.empty()) {
            return i;
        }
        if (lacking.empty()) {
            lacking = fmt::format("'{:.120}' lacks {}", candidates[i].capabilities.device_name, missing);
        }
    }
    // Without a host every device was a match, so what was lacking has been noted.
    if (!lacking.empty() || host == nullptr) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "Vulkan device", lacking, "update its driver"};
    }
    std::string devices;
    for (const DeviceCandidate& candidate : candidates) {
        devices += "; " + describeDevice(candidate.capabilities);
    }
    return Error{SLUICE_ERROR_DEVICE_MISMATCH, "device", describeHost(*host) + devices,
                 "let both APIs use one driver, for instance with VK_ICD_FILENAMES"};
}

}  // namespace sluice::vk
