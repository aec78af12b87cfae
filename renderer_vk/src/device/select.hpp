// SPDX-License-Identifier: MIT
// Which Vulkan device to take: a pure function of what was found.
#pragma once

#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

/// A physical device as far as the choice depends on it.
struct DeviceCandidate {
    SluiceRendererCapabilities capabilities{};
    VkDriverId driver{};
    bool synchronization2 = false;
    bool dynamic_rendering = false;
    bool maintenance4 = false;
    std::optional<std::uint32_t> queue_family;  ///< first with graphics and compute
};

/// Index of the first candidate that is the host's device and can run frames. With `host` null any device will do.
/// DEVICE_MISMATCH names the UUIDs of both sides; UNSUPPORTED names what the host's own device lacks.
[[nodiscard]] Result<std::size_t> selectDevice(std::span<const DeviceCandidate> candidates,
                                               const SluiceHostCapabilities* host);

/// A queue of a device: `index` within its family.
struct QueueChoice {
    std::uint32_t family = 0, index = 0;
    bool operator==(const QueueChoice&) const = default;
};
/// The queue for compute beside the first one of family `main`: that of a family without graphics, because such queues
/// are what hardware runs beside its graphics; or else a second one of `main`. Empty if there is neither.
[[nodiscard]] std::optional<QueueChoice> chooseComputeQueue(std::span<const VkQueueFamilyProperties> families,
                                                            std::uint32_t main);

/// Empty if frames can run on the device, else the first thing that it lacks.
[[nodiscard]] std::string_view missingFeature(const DeviceCandidate& candidate);

}  // namespace sluice::vk
