// SPDX-License-Identifier: MIT
#include "sluice/canary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <functional>
#include <optional>

#include "sluice/format.hpp"

namespace sluice {

namespace {

/// Avalanche of the 32-bit finaliser of MurmurHash3 (Appleby 2011): every input bit reaches every output bit.
constexpr std::uint32_t mix(std::uint32_t h) {
    h ^= h >> 16U;
    h *= 0x85ebca6bU;
    h ^= h >> 13U;
    h *= 0xc2b2ae35U;
    return h ^ (h >> 16U);
}

constexpr std::uint32_t texelHash(std::uint32_t x, std::uint32_t y, std::uint32_t channel, std::uint32_t seed) {
    return mix(mix(mix(mix(seed + 0x9e3779b9U) ^ x) + 0x7f4a7c15U * (y + 1)) ^ (channel << 28U));
}

/// A normal half float: sign, exponent 1..30 (never 0 or 31: no denormals, infinities or NaN), ten bits of mantissa.
constexpr std::uint16_t halfBits(std::uint32_t hash) {
    return static_cast<std::uint16_t>(((hash >> 31U) << 15U) | ((1U + (hash >> 10U) % 30U) << 10U) | (hash & 0x3ffU));
}

/// A normal float of any sign between 2^-20 and 2^21, all 23 bits of mantissa in use: a detour through half floats or
/// normalised integers shows.
constexpr std::uint32_t floatBits(std::uint32_t hash) {
    return ((hash >> 31U) << 31U) | ((107U + (mix(hash) % 41U)) << 23U) | (hash & 0x7fffffU);
}

/// An odd multiple of 2^-24: exact in a float, and never 0 or 1.
constexpr float depthOf(std::uint32_t hash) {
    return static_cast<float>(((hash >> 9U) << 1U) | 1U) * 0x1p-24F;
}

template <typename T>
void put(std::byte*& at, T value) {
    std::memcpy(at, &value, sizeof value);
    at += sizeof value;
}

void putTexel(std::byte* at, const FormatInfo& info, std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
    const auto hash = [=](std::uint32_t channel) { return texelHash(x, y, channel, seed); };
    switch (info.format) {
        case SLUICE_FORMAT_RGB10_A2:
            put(at, (hash(0) >> 22U) | (hash(1) >> 22U) << 10U | (hash(2) >> 22U) << 20U | (hash(3) >> 30U) << 30U);
            return;
        case SLUICE_FORMAT_R32UI:
            put(at, hash(0));
            return;
        case SLUICE_FORMAT_D32F:
            put(at, depthOf(hash(0)));
            return;
        case SLUICE_FORMAT_D24S8:
            put(at, hash(0) & 0xffffff00U);  // GL_UNSIGNED_INT_24_8, stencil 0
            return;
        default:
            break;
    }
    const std::uint32_t channel_bytes = info.bytes_per_texel / info.channels;
    for (std::uint32_t channel = 0; channel < info.channels; ++channel) {
        if (channel_bytes == 1) {
            put(at, static_cast<std::uint8_t>(hash(channel) >> 24U));
        } else if (channel_bytes == 2) {
            put(at, halfBits(hash(channel)));
        } else {
            put(at, floatBits(hash(channel)));
        }
    }
}

/// An image of `info` in GL transfer layout, with its rows tightly packed.
struct Image {
    const FormatInfo& info;
    std::uint32_t width, height;
    const std::vector<std::byte>& bytes;

    [[nodiscard]] std::size_t count() const { return std::size_t{width} * height; }
    [[nodiscard]] const std::byte* texel(std::size_t index) const { return &bytes[index * info.bytes_per_texel]; }
    [[nodiscard]] const std::byte* texel(std::uint32_t x, std::uint32_t y) const {
        return texel(std::size_t{y} * width + x);
    }
};

bool sameTexel(const FormatInfo& info, const std::byte* a, const std::byte* b) {
    return std::memcmp(a, b, info.bytes_per_texel) == 0;
}

/// Where the texel found at (x, y) would have come from, or nothing if from outside.
using Source = std::function<std::optional<std::size_t>(std::uint32_t x, std::uint32_t y)>;

/// True if the found image is the expected one with its texels moved as `source` says. Nine of ten texels must agree,
/// so that a second, smaller damage does not hide the first; and half the image must have a source, so that the test
/// means something.
bool movedBy(const Image& found, const Image& expected, const Source& source) {
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
bool damagedAreFrom(const Image& found, const Image& expected, Predicate&& texel_then) {
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

std::string channelDamage(const Image& found, const Image& expected) {
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

std::string movedDamage(const Image& found, const Image& expected) {
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

std::string describeDamage(const Image& found, const Image& expected, std::uint32_t seed) {
    const FormatInfo& info = found.info;
    const auto old = canaryPattern(info.format, found.width, found.height, seed - 1);
    const Image before{info, found.width, found.height, old};
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

std::string hexTexel(const FormatInfo& info, const std::byte* texel) {
    std::string out;
    for (std::size_t i = 0; i < info.bytes_per_texel; ++i) {
        out += fmt::format("{:02x}", std::to_integer<unsigned>(texel[i]));
    }
    return out;
}

}  // namespace

std::vector<std::byte> canaryPattern(SluiceFormat format, std::uint32_t width, std::uint32_t height,
                                     std::uint32_t seed) {
    const FormatInfo* const info = findFormat(static_cast<std::uint32_t>(format));
    assert(info != nullptr);
    if (info == nullptr) {
        return {};
    }
    std::vector<std::byte> bytes(std::size_t{width} * height * info->bytes_per_texel);
    std::byte* at = bytes.data();
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x, at += info->bytes_per_texel) {
            putTexel(at, *info, x, y, seed);
        }
    }
    return bytes;
}

Status canaryCompare(SluiceFormat format, std::uint32_t width, std::uint32_t height, std::uint32_t seed,
                     const std::vector<std::byte>& found) {
    const FormatInfo* const info = findFormat(static_cast<std::uint32_t>(format));
    if (info == nullptr) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "canary", fmt::format("{} is no format", static_cast<int>(format)),
                     "use a value of SluiceFormat"};
    }
    const auto pattern = canaryPattern(format, width, height, seed);
    const std::string thing = fmt::format("canary {} {}x{} seed {}", info->name, width, height, seed);
    if (found.size() != pattern.size()) {
        return Error{SLUICE_ERROR_CANARY, thing,
                     fmt::format("expected {} bytes, found {}", pattern.size(), found.size()),
                     "read the image with tightly packed rows"};
    }
    const Image expected{*info, width, height, pattern};
    const Image image{*info, width, height, found};
    std::size_t differing = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < image.count(); ++i) {
        if (!sameTexel(*info, image.texel(i), expected.texel(i))) {
            first = differing == 0 ? i : first;
            ++differing;
        }
    }
    if (differing == 0) {
        return {};
    }
    return Error{
        SLUICE_ERROR_CANARY, thing,
        fmt::format("{} of {} texels differ, the first at ({}, {}): expected bytes {}, found {}; looks like {}",
                    differing, image.count(), first % width, first / width, hexTexel(*info, expected.texel(first)),
                    hexTexel(*info, image.texel(first)), describeDamage(image, expected, seed)),
        "share another format, or update the drivers"};
}

}  // namespace sluice
