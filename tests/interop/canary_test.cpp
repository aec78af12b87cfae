// SPDX-License-Identifier: MIT
#include "sluice/canary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <set>

#include "sluice/format.hpp"

namespace {

using sluice::FormatInfo;
using sluice::kCanaryHeight;
using sluice::kCanaryWidth;
using sluice::TexelKind;
using ::testing::HasSubstr;

using Bytes = std::vector<std::byte>;
constexpr std::uint32_t kSeed = 11;

Bytes pattern(const FormatInfo& info, std::uint32_t seed = kSeed) {
    return sluice::canaryPattern(info.format, kCanaryWidth, kCanaryHeight, seed);
}

/// The message for `found`, empty if it was taken for the pattern.
std::string verdict(const FormatInfo& info, const Bytes& found) {
    const auto status = sluice::canaryCompare(info.format, kCanaryWidth, kCanaryHeight, kSeed, found);
    return status.ok() ? std::string() : status.error().message();
}

/// Texel (x, y) of the result is texel source(x, y) of `bytes`, or zero where that is outside.
template <typename Source>
Bytes rearranged(const FormatInfo& info, const Bytes& bytes, Source&& source) {
    Bytes out(bytes.size());
    const std::size_t size = info.bytes_per_texel;
    for (std::uint32_t y = 0; y < kCanaryHeight; ++y) {
        for (std::uint32_t x = 0; x < kCanaryWidth; ++x) {
            const std::size_t from = source(x, y) * size;
            if (from + size <= bytes.size()) {
                std::memcpy(&out[(std::size_t{y} * kCanaryWidth + x) * size], &bytes[from], size);
            }
        }
    }
    return out;
}

std::size_t at(std::uint32_t x, std::uint32_t y) {
    return std::size_t{y} * kCanaryWidth + x;
}

std::vector<std::string> formatNames(std::uint32_t least_channels) {
    std::vector<std::string> names;
    for (const FormatInfo& info : sluice::formatTable()) {
        if (info.channels >= least_channels) {
            names.emplace_back(info.name);
        }
    }
    return names;
}

class CanaryOfChannels : public testing::TestWithParam<std::string> {};
class CanaryOfFormat : public testing::TestWithParam<std::string> {};

TEST_P(CanaryOfFormat, MatchesItselfAndNoOtherSeed) {
    const FormatInfo& info = *sluice::findFormat(GetParam());
    EXPECT_EQ(pattern(info).size(), std::size_t{kCanaryWidth} * kCanaryHeight * info.bytes_per_texel);
    EXPECT_EQ(verdict(info, pattern(info)), "");
    EXPECT_EQ(pattern(info), pattern(info)) << "the pattern is a function of its arguments";
    EXPECT_NE(verdict(info, pattern(info, kSeed + 1)), "");
}

TEST_P(CanaryOfFormat, EveryTexelChangedInItsLowestBitIsFoundAndNamed) {
    const FormatInfo& info = *sluice::findFormat(GetParam());
    const Bytes good = pattern(info);
    for (std::size_t texel = 0; texel < std::size_t{kCanaryWidth} * kCanaryHeight; texel += 97) {
        Bytes bad = good;
        bad[texel * info.bytes_per_texel] ^= std::byte{1};
        const std::string message = verdict(info, bad);
        const std::string place =
            "(" + std::to_string(texel % kCanaryWidth) + ", " + std::to_string(texel / kCanaryWidth) + ")";
        EXPECT_THAT(message, HasSubstr("1 of 2881 texels differ"));
        EXPECT_THAT(message, HasSubstr(place));
        EXPECT_THAT(message, HasSubstr(std::string(info.name)));
    }
}

TEST_P(CanaryOfFormat, VerticalFlipIsNamed) {
    const FormatInfo& info = *sluice::findFormat(GetParam());
    const Bytes bad = rearranged(info, pattern(info), [](auto x, auto y) { return at(x, kCanaryHeight - 1 - y); });
    EXPECT_THAT(verdict(info, bad), HasSubstr("looks like vertical flip"));
}

TEST_P(CanaryOfFormat, HorizontalFlipIsNamed) {
    const FormatInfo& info = *sluice::findFormat(GetParam());
    const Bytes bad = rearranged(info, pattern(info), [](auto x, auto y) { return at(kCanaryWidth - 1 - x, y); });
    EXPECT_THAT(verdict(info, bad), HasSubstr("looks like horizontal flip"));
}

TEST_P(CanaryOfFormat, ShiftIsNamedWithItsDistance) {
    const FormatInfo& info = *sluice::findFormat(GetParam());
    const Bytes bad = rearranged(
        info, pattern(info), [](auto x, auto y) { return x < 3 || y < 1 ? ~std::size_t{0} / 64 : at(x - 3, y - 1); });
    EXPECT_THAT(verdict(info, bad), HasSubstr("looks like shift by (3, 1) texels"));
}

TEST_P(CanaryOfFormat, WrongRowStrideIsNamed) {
    const FormatInfo& info = *sluice::findFormat(GetParam());
    const Bytes bad = rearranged(info, pattern(info), [](auto x, auto y) { return std::size_t{y} * 80 + x; });
    EXPECT_THAT(verdict(info, bad), HasSubstr("read with a stride of 80 texels"));
}

TEST_P(CanaryOfFormat, StaleImageIsNamed) {
    const FormatInfo& info = *sluice::findFormat(GetParam());
    EXPECT_THAT(verdict(info, pattern(info, kSeed - 1)),
                HasSubstr("looks like stale: the damaged texels hold the pattern"));
    EXPECT_THAT(verdict(info, Bytes(pattern(info).size())), HasSubstr("looks like stale: the damaged texels are zero"));
}

TEST_P(CanaryOfFormat, TornImageIsNamedStale) {
    // Software drivers tear by 64x64 tiles: a part is old, the rest is new.
    const FormatInfo& info = *sluice::findFormat(GetParam());
    Bytes bad = pattern(info);
    const Bytes old = pattern(info, kSeed - 1);
    std::copy_n(old.begin(), old.size() / 3, bad.begin());
    EXPECT_THAT(verdict(info, bad), HasSubstr("looks like stale: the damaged texels hold"));
}

TEST_P(CanaryOfFormat, NoiseIsNamedOther) {
    const FormatInfo& info = *sluice::findFormat(GetParam());
    EXPECT_THAT(verdict(info, pattern(info, kSeed + 77)), HasSubstr("looks like other"));
}

TEST_P(CanaryOfFormat, WrongSizeIsNamed) {
    const FormatInfo& info = *sluice::findFormat(GetParam());
    Bytes bad = pattern(info);
    bad.pop_back();
    EXPECT_THAT(verdict(info, bad), HasSubstr("expected " + std::to_string(bad.size() + 1) + " bytes"));
}

TEST_P(CanaryOfChannels, ChannelSwapIsNamed) {
    const FormatInfo& info = *sluice::findFormat(GetParam());
    Bytes bad = pattern(info);
    const std::size_t size = info.bytes_per_texel / info.channels;
    std::string expected = "looks like channel swap";
    if (info.kind == TexelKind::DepthStencil) {
        // What comes of copying Vulkan's packing (stencil high, depth low) without turning it.
        for (std::size_t i = 0; i < bad.size(); i += 4) {
            std::rotate(&bad[i], &bad[i] + 1, &bad[i] + 4);
        }
        expected = "depth packed in the low 24 bits";
    } else if (info.format == SLUICE_FORMAT_RGB10_A2) {
        for (std::size_t i = 0; i < bad.size(); i += 4) {
            std::uint32_t word = 0;
            std::memcpy(&word, &bad[i], 4);
            word = (word & 0xc00ffc00U) | ((word & 0x3ffU) << 20U) | ((word >> 20U) & 0x3ffU);
            std::memcpy(&bad[i], &word, 4);
        }
    } else {
        const std::size_t other = info.channels == 4 ? 2 : 1;  // BGRA, or GR
        for (std::size_t i = 0; i < bad.size(); i += info.bytes_per_texel) {
            std::swap_ranges(&bad[i], &bad[i] + size, &bad[i + other * size]);
        }
    }
    EXPECT_THAT(verdict(info, bad), HasSubstr(expected));
}

TEST_P(CanaryOfFormat, ValuesSurviveAnyExactTransfer) {
    const FormatInfo& info = *sluice::findFormat(GetParam());
    const Bytes bytes = pattern(info);
    const std::size_t size = info.bytes_per_texel / info.channels;
    for (std::size_t i = 0; i < bytes.size(); i += size) {
        if (info.kind == TexelKind::Depth) {
            float depth = 0;
            std::memcpy(&depth, &bytes[i], sizeof depth);
            ASSERT_GT(depth, 0.0F);
            ASSERT_LT(depth, 1.0F);
        } else if (info.kind == TexelKind::Float && size == 4) {
            float value = 0;
            std::memcpy(&value, &bytes[i], sizeof value);
            ASSERT_TRUE(std::isnormal(value)) << value;
        } else if (info.kind == TexelKind::Float) {
            std::uint16_t half = 0;
            std::memcpy(&half, &bytes[i], sizeof half);
            const unsigned exponent = (half >> 10U) & 31U;
            ASSERT_TRUE(exponent != 0 && exponent != 31) << "zero, denormal, infinite or NaN half";
        }
    }
    if (info.kind == TexelKind::DepthStencil) {
        for (std::size_t i = 0; i < bytes.size(); i += 4) {
            ASSERT_EQ(bytes[i], std::byte{0}) << "stencil";
        }
    }
}

TEST_P(CanaryOfFormat, NeighboursRowsColumnsAndChannelsDiffer) {
    const FormatInfo& info = *sluice::findFormat(GetParam());
    const Bytes bytes = pattern(info);
    const std::size_t row = std::size_t{kCanaryWidth} * info.bytes_per_texel;
    std::set<Bytes> rows;
    for (std::size_t y = 0; y < kCanaryHeight; ++y) {
        const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(y * row);
        rows.insert(Bytes(begin, begin + static_cast<std::ptrdiff_t>(row)));
    }
    EXPECT_EQ(rows.size(), kCanaryHeight);
    const std::size_t texels = std::size_t{kCanaryWidth} * kCanaryHeight;
    std::size_t equal_neighbours = 0;
    for (std::size_t i = 0; i + 1 < texels; ++i) {
        const auto* const texel = &bytes[i * info.bytes_per_texel];
        equal_neighbours += std::memcmp(texel, texel + info.bytes_per_texel, info.bytes_per_texel) == 0 ? 1U : 0U;
    }
    // 8-bit texels meet their like by chance in one of 256 cases.
    EXPECT_LT(equal_neighbours, texels / 100);
}

INSTANTIATE_TEST_SUITE_P(EveryFormat, CanaryOfFormat, testing::ValuesIn(formatNames(1)),
                         [](const auto& format) { return format.param; });
INSTANTIATE_TEST_SUITE_P(SeveralChannels, CanaryOfChannels, testing::ValuesIn(formatNames(2)),
                         [](const auto& format) { return format.param; });

TEST(Canary, RefusesAnUnknownFormat) {
    const auto status = sluice::canaryCompare(SLUICE_FORMAT_NONE, 4, 4, 1, {});
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
}

RC_GTEST_PROP(Canary, AnyDamageToAnyImageIsFound, ()) {
    const auto format = static_cast<SluiceFormat>(*rc::gen::inRange<int>(1, SLUICE_FORMAT_COUNT));
    const auto width = *rc::gen::inRange<std::uint32_t>(1, 40);
    const auto height = *rc::gen::inRange<std::uint32_t>(1, 40);
    const auto seed = *rc::gen::arbitrary<std::uint32_t>();
    Bytes bytes = sluice::canaryPattern(format, width, height, seed);
    RC_ASSERT(sluice::canaryCompare(format, width, height, seed, bytes).ok());
    const auto index = *rc::gen::inRange<std::size_t>(0, bytes.size());
    bytes[index] ^= static_cast<std::byte>(*rc::gen::inRange<int>(1, 256));
    const auto status = sluice::canaryCompare(format, width, height, seed, bytes);
    RC_ASSERT(!status.ok());
    RC_ASSERT(status.error().code == SLUICE_ERROR_CANARY);
}

}  // namespace
