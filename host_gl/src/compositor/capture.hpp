// SPDX-License-Identifier: MIT
// The host's colour and depth into shared images, on the GPU.
#pragma once

#include <cstdint>

namespace sluice::host {

/// Copies the lower left width x height of the framebuffer's colour (if `colour` is not 0) and window depth (if `depth`
/// is not 0) into textures. Formats convert on the GPU: 24-bit depth arrives in a D32F texture within 1.2e-7. Leaves
/// all GL state as found.
void captureScreen(std::uint32_t framebuffer, std::uint32_t width, std::uint32_t height, std::uint32_t colour,
                   std::uint32_t depth);

}  // namespace sluice::host
