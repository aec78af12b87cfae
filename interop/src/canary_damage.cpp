// SPDX-License-Identifier: MIT
#include "canary_damage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <functional>
#include <optional>
#include <string_view>

#include "sluice/canary.hpp"

namespace sluice {

namespace {

/// Where the texel found at (x, y) would have come from, or nothing if from outside.
using Source = std::function<std::optional<std::size_t>(std::uint32_t x, std::uint32_t y)>;

/// True if the found image is the expected one with its texels moved as `source` says. Nine of ten texels must agree,
/// so that a second, smaller damage does not hide the first; and half the image must have a source, so that the test
/// means something.
bool movedBy(const CanaryImage& found, const CanaryImage& expected, const Source& source) {
    std::size_t inside = 0;
    std::size_t equal = 0;
    for (std::uint32_t y = 0; y < found.height; ++y) {
        for (std::uint32_t x = 0; x < found.width; ++x) {
            if (const auto from = source(x, y); from && *from < expected.count()) {
                ++inside;
                equal += sameTexel(found.info, found.texel(x, y), expected.texel(*from)) ? 1U : 0U;
            }
        }
    }
    return inside * 2 >= found.count() && equal * 10 >= inside * 9;
}

/// True if nine of ten damaged texels are what `texel_then` says they were before: the image, or part of it, is from
/// another time. The tenth leaves room for texels torn inside.
template <typename Predicate>
bool damagedAreFrom(const CanaryImage& found, const CanaryImage& expected, Predicate&& texel_then) {
    std::size_t damaged = 0;
    std::size_t old = 0;
    for (std::size_t i = 0; i < found.count(); ++i) {
        if (!sameTexel(found.info, found.texel(i), expected.texel(i))) {
            ++damaged;
            old += texel_then(i) ? 1U : 0U;
        }
    }
    return old * 10 >= damaged * 9;
}

using TexelBytes = std::array<std::byte, 16>;

/// The texel with its channels in the order `from` (channel i of the result is channel from[i] of `texel`).
TexelBytes reordered(const FormatInfo& info, const std::byte* texel, const std::array<std::uint32_t, 4>& from) {
    TexelBytes out{};
    if (info.format == SLUICE_FORMAT_RGB10_A2) {
        std::uint32_t word = 0;
        std::memcpy(&word, texel, sizeof word);
        std::uint32_t result = word & 0xc0000000U;
        for (std::uint32_t i = 0; i < 3; ++i) {
            result |= ((word >> (10U * from[i])) & 0x3ffU) << (10U * i);
        }
        std::memcpy(out.data(), &result, sizeof result);
        return out;
    }
    const std::size_t size = info.bytes_per_texel / info.channels;
    for (std::size_t i = 0; i < info.channels; ++i) {
        std::memcpy(&out[i * size], texel + from[i] * size, size);
    }
    return out;
}

std::string channelDamage(const CanaryImage& found, const CanaryImage& expected) {
    const FormatInfo& info = found.info;
    const auto explains = [&](const auto& transform) {
        std::size_t equal = 0;
        for (std::size_t i = 0; i < found.count(); ++i) {
            const TexelBytes moved = transform(expected.texel(i));
            equal += sameTexel(info, found.texel(i), moved.data()) ? 1U : 0U;
        }
        return equal * 10 >= found.count() * 9;
    };
    if (info.kind == TexelKind::DepthStencil) {
        const auto turned = [](const std::byte* texel) {
            std::uint32_t word = 0;
            std::memcpy(&word, texel, sizeof word);
            word = std::rotr(word, 8);
            TexelBytes out{};
            std::memcpy(out.data(), &word, sizeof word);
            return out;
        };
        return explains(turned) ? "depth packed in the low 24 bits instead of the high ones" : "";
    }
    if (info.channels < 2) {
        return {};
    }
    std::array<std::uint32_t, 4> order{0, 1, 2, 3};
    const std::uint32_t permuted = info.format == SLUICE_FORMAT_RGB10_A2 ? 3U : info.channels;
    while (std::next_permutation(order.begin(), order.begin() + permuted)) {
        if (explains([&](const std::byte* texel) { return reordered(info, texel, order); })) {
            constexpr std::string_view kNames = "RGBA";
            std::string names;
            for (std::uint32_t i = 0; i < info.channels; ++i) {
                names += kNames[order[i]];
            }
            return fmt::format("channel swap (found {} where {} was written)", names, kNames.substr(0, info.channels));
        }
    }
    return {};
}

std::string movedDamage(const CanaryImage& found, const CanaryImage& expected) {
    const std::uint32_t width = found.width;
    const std::uint32_t height = found.height;
    const auto at = [width](std::uint32_t x, std::uint32_t y) { return std::size_t{y} * width + x; };
    if (movedBy(found, expected, [&](auto x, auto y) { return std::optional(at(x, height - 1 - y)); })) {
        return "vertical flip";
    }
    if (movedBy(found, expected, [&](auto x, auto y) { return std::optional(at(width - 1 - x, y)); })) {
        return "horizontal flip";
    }
    if (movedBy(found, expected, [&](auto x, auto y) { return std::optional(at(width - 1 - x, height - 1 - y)); })) {
        return "turned by 180 degrees";
    }
    constexpr int kReach = 8;
    for (int dy = -kReach; dy <= kReach; ++dy) {
        for (int dx = -kReach; dx <= kReach; ++dx) {
            const auto source = [&](std::uint32_t x, std::uint32_t y) -> std::optional<std::size_t> {
                const std::int64_t sx = std::int64_t{x} - dx;
                const std::int64_t sy = std::int64_t{y} - dy;
                if (sx < 0 || sy < 0 || sx >= width || sy >= height) {
                    return std::nullopt;
                }
                return at(static_cast<std::uint32_t>(sx), static_cast<std::uint32_t>(sy));
            };
            if ((dx != 0 || dy != 0) && movedBy(found, expected, source)) {
                return fmt::format("shift by ({}, {}) texels", dx, dy);
            }
        }
    }
    // A reader with another row stride sees each row start a little further on than the last.
    constexpr std::uint32_t kStrideReach = 64;
    for (std::uint32_t stride = width > kStrideReach ? width - kStrideReach : 1; stride <= width + kStrideReach;
         ++stride) {
        const auto source = [&](std::uint32_t x, std::uint32_t y) {
            return std::optional(std::size_t{y} * stride + x);
        };
        if (stride != width && movedBy(found, expected, source)) {
            return fmt::format("shift from row to row: read with a stride of {} texels", stride);
        }
    }
    return {};
}

}  // namespace

bool sameTexel(const FormatInfo& info, const std::byte* a, const std::byte* b) {
    return std::memcmp(a, b, info.bytes_per_texel) == 0;
}

std::string describeDamage(const CanaryImage& found, const CanaryImage& expected, std::uint32_t seed) {
    const FormatInfo& info = found.info;
    const auto old = canaryPattern(info.format, found.width, found.height, seed - 1);
    const CanaryImage before{info, found.width, found.height, old};
    if (damagedAreFrom(found, expected,
                       [&](std::size_t i) { return sameTexel(info, found.texel(i), before.texel(i)); })) {
        return "stale: the damaged texels hold the pattern of the seed before";
    }
    const TexelBytes zero{};
    if (damagedAreFrom(found, expected, [&](std::size_t i) { return sameTexel(info, found.texel(i), zero.data()); })) {
        return "stale: the damaged texels are zero, never written";
    }
    if (std::string damage = channelDamage(found, expected); !damage.empty()) {
        return damage;
    }
    if (std::string damage = movedDamage(found, expected); !damage.empty()) {
        return damage;
    }
    return "other: neither flipped, swapped, shifted nor stale";
}

}  // namespace sluice
