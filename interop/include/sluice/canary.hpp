// SPDX-License-Identifier: MIT
// The pattern by which an image proves that its contents cross from one API to the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice {

/// Odd on purpose: a wrong stride, tiling or row order cannot hide in it.
inline constexpr std::uint32_t kCanaryWidth = 67;
inline constexpr std::uint32_t kCanaryHeight = 43;

/// Texels in GL transfer layout, rows tightly packed, row 0 first. Every texel depends on x, y, channel and seed, so
/// that a swap of channels, a flip, a shift or a stale image shows. Floats are finite, depth lies in (0,1), and half
/// floats are exactly representable. For D24S8 this is GL's GL_UNSIGNED_INT_24_8 packing with stencil 0.
[[nodiscard]] std::vector<std::byte> canaryPattern(SluiceFormat format, std::uint32_t width, std::uint32_t height,
                                                   std::uint32_t seed);

/// Compares `found` (GL transfer layout, tightly packed) with the pattern. The error names the first bad texel, what
/// was expected and found, how many differ, and what kind of damage it looks like (flip, channel swap, shift, stale,
/// other).
[[nodiscard]] Status canaryCompare(SluiceFormat format, std::uint32_t width, std::uint32_t height, std::uint32_t seed,
                                   const std::vector<std::byte>& found);

}  // namespace sluice
