// SPDX-License-Identifier: MIT
// What went wrong with a canary that came back changed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sluice/format.hpp"

namespace sluice {

/// An image of `info` in GL transfer layout, with its rows tightly packed.
struct CanaryImage {
    const FormatInfo& info;
    std::uint32_t width, height;
    const std::vector<std::byte>& bytes;

    [[nodiscard]] std::size_t count() const { return std::size_t{width} * height; }
    [[nodiscard]] const std::byte* texel(std::size_t index) const { return &bytes[index * info.bytes_per_texel]; }
    [[nodiscard]] const std::byte* texel(std::uint32_t x, std::uint32_t y) const {
        return texel(std::size_t{y} * width + x);
    }
};

[[nodiscard]] bool sameTexel(const FormatInfo& info, const std::byte* a, const std::byte* b);

/// What the difference between the two looks like; `expected` is the pattern of `seed`.
[[nodiscard]] std::string describeDamage(const CanaryImage& found, const CanaryImage& expected, std::uint32_t seed);

}  // namespace sluice
