// SPDX-License-Identifier: MIT
// The plain numbers of the format table against the headers that define them.
#include "sluice/format.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <vulkan/vulkan.h>

#include <set>
#include <string>

namespace {

using sluice::FormatInfo;
using sluice::TexelKind;

struct Registry {
    SluiceFormat format;
    std::string_view name;
    VkFormat vk;
    GLenum internal, transfer, type;
    std::uint32_t bytes, channels;
};

constexpr Registry kRegistry[] = {
    {SLUICE_FORMAT_R8, "R8", VK_FORMAT_R8_UNORM, GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1, 1},
    {SLUICE_FORMAT_RGBA8, "RGBA8", VK_FORMAT_R8G8B8A8_UNORM, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4, 4},
    {SLUICE_FORMAT_SRGB8_A8, "SRGB8_A8", VK_FORMAT_R8G8B8A8_SRGB, GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, 4, 4},
    {SLUICE_FORMAT_RGB10_A2, "RGB10_A2", VK_FORMAT_A2B10G10R10_UNORM_PACK32, GL_RGB10_A2, GL_RGBA,
     GL_UNSIGNED_INT_2_10_10_10_REV, 4, 4},
    {SLUICE_FORMAT_R16F, "R16F", VK_FORMAT_R16_SFLOAT, GL_R16F, GL_RED, GL_HALF_FLOAT, 2, 1},
    {SLUICE_FORMAT_RG16F, "RG16F", VK_FORMAT_R16G16_SFLOAT, GL_RG16F, GL_RG, GL_HALF_FLOAT, 4, 2},
    {SLUICE_FORMAT_RGBA16F, "RGBA16F", VK_FORMAT_R16G16B16A16_SFLOAT, GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8, 4},
    {SLUICE_FORMAT_R32F, "R32F", VK_FORMAT_R32_SFLOAT, GL_R32F, GL_RED, GL_FLOAT, 4, 1},
    {SLUICE_FORMAT_RG32F, "RG32F", VK_FORMAT_R32G32_SFLOAT, GL_RG32F, GL_RG, GL_FLOAT, 8, 2},
    {SLUICE_FORMAT_RGBA32F, "RGBA32F", VK_FORMAT_R32G32B32A32_SFLOAT, GL_RGBA32F, GL_RGBA, GL_FLOAT, 16, 4},
    {SLUICE_FORMAT_R32UI, "R32UI", VK_FORMAT_R32_UINT, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4, 1},
    {SLUICE_FORMAT_D32F, "D32F", VK_FORMAT_D32_SFLOAT, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4, 1},
    {SLUICE_FORMAT_D24S8, "D24S8", VK_FORMAT_D24_UNORM_S8_UINT, GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL,
     GL_UNSIGNED_INT_24_8, 4, 2},
};

TEST(FormatTable, EveryValueEqualsItsRegistry) {
    ASSERT_EQ(sluice::formatTable().size(), std::size(kRegistry));
    for (const Registry& expected : kRegistry) {
        SCOPED_TRACE(expected.name);
        const FormatInfo* const info = sluice::findFormat(expected.format);
        ASSERT_NE(info, nullptr);
        EXPECT_EQ(info->name, expected.name);
        EXPECT_EQ(info->vk_format, static_cast<std::uint32_t>(expected.vk));
        EXPECT_EQ(info->gl_internal, expected.internal);
        EXPECT_EQ(info->gl_transfer_format, expected.transfer);
        EXPECT_EQ(info->gl_transfer_type, expected.type);
        EXPECT_EQ(info->bytes_per_texel, expected.bytes);
        EXPECT_EQ(info->channels, expected.channels);
    }
}

TEST(FormatTable, IsInTheOrderOfTheAbiAndFindsItsRowsByNumberAndName) {
    std::uint32_t format = SLUICE_FORMAT_NONE + 1;
    std::set<std::string_view> names;
    for (const FormatInfo& info : sluice::formatTable()) {
        EXPECT_EQ(info.format, static_cast<SluiceFormat>(format));
        EXPECT_EQ(sluice::findFormat(format), &info);
        EXPECT_EQ(sluice::findFormat(info.name), &info);
        EXPECT_TRUE(names.insert(info.name).second) << info.name << " twice";
        EXPECT_FALSE(info.host_use.empty());
        EXPECT_FALSE(info.renderer_use.empty());
        ++format;
    }
    EXPECT_EQ(format, static_cast<std::uint32_t>(SLUICE_FORMAT_COUNT));
}

TEST(FormatTable, KnowsNoOtherFormat) {
    EXPECT_EQ(sluice::findFormat(SLUICE_FORMAT_NONE), nullptr);
    EXPECT_EQ(sluice::findFormat(SLUICE_FORMAT_COUNT), nullptr);
    EXPECT_EQ(sluice::findFormat(0xffffffffU), nullptr);
    EXPECT_EQ(sluice::findFormat("r32f"), nullptr);
    EXPECT_EQ(sluice::findFormat(""), nullptr);
}

TEST(FormatTable, NamesTheTrapsThatPassSilently) {
    EXPECT_NE(sluice::findFormat("RGBA8")->hazard.find("B8G8R8A8"), std::string_view::npos);
    EXPECT_NE(sluice::findFormat("RGB10_A2")->hazard.find("A2R10G10B10"), std::string_view::npos);
    EXPECT_NE(sluice::findFormat("D32F")->hazard.find("optimal tiling only"), std::string_view::npos);
    EXPECT_NE(sluice::findFormat("D24S8")->hazard.find("high 24 bits"), std::string_view::npos);
    for (const FormatInfo& info : sluice::formatTable()) {
        EXPECT_EQ(info.exact_round_trip, info.format != SLUICE_FORMAT_D24S8) << info.name;
    }
}

TEST(FormatTable, KindsFollowTheTransferFormat) {
    for (const FormatInfo& info : sluice::formatTable()) {
        SCOPED_TRACE(info.name);
        switch (info.gl_transfer_format) {
            case GL_DEPTH_COMPONENT:
                EXPECT_EQ(info.kind, TexelKind::Depth);
                break;
            case GL_DEPTH_STENCIL:
                EXPECT_EQ(info.kind, TexelKind::DepthStencil);
                break;
            case GL_RED_INTEGER:
                EXPECT_EQ(info.kind, TexelKind::UnsignedInteger);
                break;
            default: {
                const bool is_float = info.gl_transfer_type == GL_FLOAT || info.gl_transfer_type == GL_HALF_FLOAT;
                EXPECT_EQ(info.kind, is_float ? TexelKind::Float : TexelKind::UnsignedNormalized);
            }
        }
    }
}

TEST(Names, EveryRoleHasItsOwn) {
    std::set<std::string_view> names;
    for (int role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
        EXPECT_TRUE(names.insert(sluice::toString(static_cast<SluiceImageRole>(role))).second) << role;
    }
    EXPECT_FALSE(names.contains(sluice::toString(SLUICE_IMAGE_ROLE_COUNT)));
    EXPECT_EQ(sluice::toString(SLUICE_IMAGE_HOST_DEPTH), "HOST_DEPTH");
}

TEST(ParseTimelineKind, ReadsEveryNameThatIsWritten) {
    for (int number = 0; number < SLUICE_TIMELINE_KIND_COUNT; ++number) {
        const auto kind = static_cast<SluiceTimelineKind>(number);
        EXPECT_EQ(sluice::parseTimelineKind(sluice::toString(kind)), kind);
    }
    EXPECT_EQ(sluice::parseTimelineKind("native"), SLUICE_TIMELINE_NATIVE);
    EXPECT_EQ(sluice::parseTimelineKind("auto"), SLUICE_TIMELINE_AUTO);
    EXPECT_EQ(sluice::toString(SLUICE_TIMELINE_KIND_COUNT), "unknown timeline");
}

TEST(ParseTimelineKind, RefusesWhatIsAlmostAName) {
    for (const std::string_view name :
         {"", "Native", "native ", " native", "nativ", "nativee", "unknown timeline", "1"}) {
        EXPECT_EQ(sluice::parseTimelineKind(name), std::nullopt) << '"' << name << '"';
    }
}

RC_GTEST_PROP(ParseTimelineKind, AcceptsAnyTextOnlyIfItIsExactlyAName, ()) {
    // Random text hardly ever is a name, so half of the cases start from one and change a little of it.
    std::string text = *rc::gen::arbitrary<std::string>();
    if (*rc::gen::arbitrary<bool>()) {
        text = std::string(sluice::toString(static_cast<SluiceTimelineKind>(*rc::gen::inRange(0, 6))));
        if (*rc::gen::arbitrary<bool>()) {
            text[*rc::gen::inRange<std::size_t>(0, text.size())] = *rc::gen::arbitrary<char>();
        }
    }
    const auto kind = sluice::parseTimelineKind(text);
    bool is_name = false;
    for (int number = 0; number < SLUICE_TIMELINE_KIND_COUNT; ++number) {
        is_name = is_name || text == sluice::toString(static_cast<SluiceTimelineKind>(number));
    }
    RC_ASSERT(kind.has_value() == is_name);
    // Not "!kind ||": RC_ASSERT captures its operands and evaluates both.
    if (kind) {
        RC_ASSERT(sluice::toString(*kind) == text);
    }
}

RC_GTEST_PROP(FormatTable, FindsAnyNumberOnlyIfItIsInTheTable, ()) {
    const auto number = *rc::gen::oneOf(rc::gen::arbitrary<std::uint32_t>(), rc::gen::inRange<std::uint32_t>(0, 20));
    const FormatInfo* const info = sluice::findFormat(number);
    RC_ASSERT((info != nullptr) == (number >= 1 && number < SLUICE_FORMAT_COUNT));
    if (info != nullptr) {
        RC_ASSERT(static_cast<std::uint32_t>(info->format) == number);
    }
}

}  // namespace
