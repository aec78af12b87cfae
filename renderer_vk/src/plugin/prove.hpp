// SPDX-License-Identifier: MIT
// The canary: does an image of this format carry its texels to the host and back?
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "device/device.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Fills an exportable image with a pattern, lets the host check and replace it, and checks what comes back. Fails with
/// CANARY, IMPORT or UNSUPPORTED and the reason. `seed` makes a stale image show.
[[nodiscard]] Status proveFormat(const Device& device, const SluiceHostServices& host, SluiceFormat format,
                                 std::uint32_t width, std::uint32_t height, std::uint32_t seed);

/// GL packs D24S8 with depth in the high 24 bits, Vulkan copies the depth aspect in the low 24: one to the other, in
/// place.
void depth24FromGl(std::vector<std::byte>& texels);
void depth24ToGl(std::vector<std::byte>& texels);

}  // namespace sluice::vk
