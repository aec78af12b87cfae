// SPDX-License-Identifier: MIT
#include "sluice/canary.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cstring>

#include "canary_damage.hpp"
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
    const CanaryImage expected{*info, width, height, pattern};
    const CanaryImage image{*info, width, height, found};
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
