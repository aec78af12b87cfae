// SPDX-License-Identifier: MIT
// Capabilities of driver pairs. Only those of llvmpipe and lavapipe were recorded on a machine; the others are assumed
// from specifications and issue reports, and stand for the shapes that negotiation has to tell apart.
#pragma once

#include <cstdint>
#include <string_view>

#include "sluice/plugin.h"

namespace sluice::test {

/// Both sides of one machine.
struct DriverPair {
    std::string_view name;
    std::string_view source;  ///< "recorded ..." or "assumed ...": where the values come from
    SluiceHostCapabilities gl{};
    SluiceRendererCapabilities vk{};
};

[[nodiscard]] DriverPair recordedMesa22Software();     ///< llvmpipe and lavapipe 22.3.6
[[nodiscard]] DriverPair assumedNvidiaWithTimeline();  ///< proprietary, with GL_NV_timeline_semaphore
[[nodiscard]] DriverPair assumedNvidiaWithoutTimeline();
[[nodiscard]] DriverPair assumedRadeonMesa24();  ///< radeonsi and radv
[[nodiscard]] DriverPair assumedHybridLaptop();  ///< OpenGL on the integrated GPU, Vulkan on the discrete one

inline constexpr std::uint32_t kAllFormats = (1U << static_cast<std::uint32_t>(SLUICE_FORMAT_COUNT)) - 2U;
inline constexpr std::uint32_t kDepthFormats = 1U << SLUICE_FORMAT_D32F | 1U << SLUICE_FORMAT_D24S8;

}  // namespace sluice::test
