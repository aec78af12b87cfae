// SPDX-License-Identifier: MIT
// Several looks in one frame: optical depth, its blur and Beer's law with it, in double precision.
#include <algorithm>
#include <array>
#include <cmath>

#include "pass_scenes.hpp"
#include "reference/fluid_reference.hpp"

namespace sluice::vk::test {
namespace {

/// Every third particle is of the first fluid, of kWater; the others absorb otherwise, the last of them nothing of red.
RigScene mixed(RigScene scene) {
    for (std::size_t i = 0; i < std::max(scene.positions.size() / 3, scene.ellipsoids.size() / 9); ++i) {
        scene.fluids.push_back(static_cast<std::uint32_t>(i * 7 % 3));
    }
    scene.absorption = {{0.4F, 1.5F, 6.0F}, {0.0F, 3.0F, 0.2F}};
    return scene;
}

void expectOpticalDepth(const RigScene& scene, double outline) {
    RigScene sharp = scene;
    sharp.fluid.thickness_blur = 0.0F;
    const RigResult result = rendered(sharp);
    const ReferenceFrame frame(sharp);
    const auto expected = referenceOpticalDepth(frame, result.thickness_width, result.thickness_height);
    ASSERT_EQ(result.optical.size(), expected.size());
    std::size_t covered = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_NEAR(double{result.optical[i][k]}, expected[i][k],
                        6.0 * outline * frame.splat_radius + 1e-5 * expected[i][k])
                << "channel " << k << " of texel " << i;
        }
        covered += expected[i][2] > 0.0 ? 1U : 0U;
    }
    EXPECT_GT(covered, expected.size() / 20);
    // The metres beside it, the surface and the outline are those of one look, to the bit.
    RigScene one = sharp;
    one.absorption.clear();
    const RigResult alike = rendered(one);
    EXPECT_TRUE(alike.optical.empty());
    EXPECT_EQ(alike.thickness, result.thickness);
    EXPECT_EQ(alike.surface, result.surface);
    EXPECT_EQ(alike.depth, result.depth);
}

TEST(OpticalDepth, OfACloudMatchesAtFullAndReducedResolution) {
    for (const float scale : {1.0F, 0.5F}) {
        RigScene scene = mixed(withoutFilter(cloud(200, 0.12F)));
        scene.fluid.thickness_scale = scale;
        expectOpticalDepth(scene, 2e-2);
    }
}

TEST(OpticalDepth, EndsAtTheScene) {
    RigScene scene = mixed(withoutFilter(cloud(200, 0.2F)));
    scene.encoding = SLUICE_DEPTH_LINEAR;
    for (std::uint32_t i = 0; i < scene.width * scene.height; ++i) {
        scene.host_depth.push_back(1.0F + 0.05F * static_cast<float>(i % scene.width));
    }
    expectOpticalDepth(scene, 2e-2);
}

TEST(OpticalDepth, OfEllipsoidsMatches) {
    RigScene scene = withoutFilter(cloud(150, 0.15F));
    for (std::size_t i = 0; i < scene.positions.size(); i += 3) {
        scene.ellipsoids.insert(scene.ellipsoids.end(), {scene.positions[i], scene.positions[i + 1],
                                                         scene.positions[i + 2], 1.4F, 0.3F, 0.0F, 0.9F, 0.1F, 0.8F});
    }
    scene.positions.clear();
    scene.longest = 1.6F;
    expectOpticalDepth(mixed(scene), 3e-2);
}

TEST(OpticalDepth, IsBlurredAsThicknessIsWithItsWeights) {
    RigScene scene = mixed(cloud(300, 0.12F));
    scene.absorption[1][0] = 0.3F;  // so that every channel is above 0 where there is fluid, as the reference asks
    RigScene sharp = scene;
    sharp.fluid.thickness_blur = 0.0F;
    const RigResult raw = rendered(sharp);
    const RigResult blurred = rendered(scene);
    for (std::size_t k = 0; k < 3; ++k) {
        std::vector<double> channel(raw.optical.size());
        std::ranges::transform(raw.optical, channel.begin(), [k](const auto& texel) { return double{texel[k]}; });
        const auto expected =
            referenceBlur(ReferenceFrame(scene), channel, raw.thickness_width, raw.thickness_height, blurred.surface);
        const double largest = *std::ranges::max_element(channel);
        ASSERT_GT(largest, 0.0);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            ASSERT_NEAR(double{blurred.optical[i][k]}, expected[i], 1e-5 * largest) << k << " at texel " << i;
        }
    }
}

double encoded(double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

/// Nothing but what comes through: a grey behind everything, no highlight, no mirror image of the sky.
TEST(SeveralLooks, WhatComesThroughIsBeersLawOfAllThatLiesInTheWay) {
    RigScene scene = mixed(cloud(400, 0.2F));
    scene.outputs = ~0U;
    scene.fluid.thickness_scale = 1.0F;
    scene.fluid.thickness_blur = 0.0F;
    scene.fluid.reflection = 0;
    std::fill_n(scene.fluid.scatter_colour, 3, 0.0F);
    std::fill_n(scene.sky.sun_radiance, 3, 0.0F);
    // A wall in the fluid: its texels are grey, too, and what is behind it absorbs nothing.
    scene.encoding = SLUICE_DEPTH_LINEAR;
    for (std::uint32_t i = 0; i < scene.width * scene.height; ++i) {
        scene.host_depth.push_back(i % scene.width < 50 ? 1.0F + 0.05F * static_cast<float>(i % 50) : INFINITY);
    }
    const RigResult result = rendered(scene);
    const double grey = std::pow((128 / 255.0 + 0.055) / 1.055, 2.4);
    std::size_t compared = 0;
    std::size_t cut = 0;
    for (std::size_t i = 0; i < result.depth.size(); ++i) {
        const double metres = double{result.thickness[i]};
        if (result.colour[i][3] == 0.0F || metres == 0.0) {
            continue;
        }
        const double path = double{result.thickness_out[i]};
        for (std::size_t k = 0; k < 3; ++k) {
            const double expected = encoded(grey * std::exp(-double{result.optical[i][k]} * (path / metres)));
            ASSERT_NEAR(double{result.colour[i][k]}, expected, 2e-3) << k << " at texel " << i;
        }
        ++compared;
        cut += path < 0.9 * metres ? 1U : 0U;
    }
    EXPECT_GT(compared, 500U);
    EXPECT_GT(cut, 20U) << "where the wall is nearer than the fluid is thick";
}

TEST(SeveralLooks, ThatAreAlikeAreOne) {
    RigScene scene = mixed(cloud(400, 0.2F));
    for (std::array<float, 3>& look : scene.absorption) {
        std::copy_n(scene.fluid.absorption, 3, look.begin());
    }
    const RigResult several = rendered(scene);
    ASSERT_FALSE(several.optical.empty());
    scene.absorption.clear();
    const RigResult one = rendered(scene);
    for (std::size_t i = 0; i < one.colour.size(); ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            ASSERT_NEAR(several.colour[i][k], one.colour[i][k], 1e-3F) << i;
        }
    }
}

}  // namespace
}  // namespace sluice::vk::test
