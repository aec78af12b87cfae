// SPDX-License-Identifier: MIT
// What a test may ask of the Vulkan layer that lets calls of the renderer fail.
#pragma once

#include <cstdint>

namespace sluice::host::test {

constexpr const char* kVkFaultSymbol = "sluice_vk_faults";

/// Everything zero: every call goes on to the driver. One device at a time; the thread that makes the calls.
struct VkFaults {
    /// This call of those that make or allocate something, from 1, has no memory; 0: none.
    std::uint64_t starve_at = 0;
    /// From this submission on, from 1, the device is lost, until another one is created; 0: never.
    std::uint64_t lose_at = 0;
    std::uint64_t made = 0, submitted = 0;  ///< calls so far
    bool lost = false;
};

}  // namespace sluice::host::test
