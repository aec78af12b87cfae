// SPDX-License-Identifier: MIT
// Foam that particles carry: its sum along the view ray and what it covers, against double precision.
#include <algorithm>
#include <cmath>
#include <random>

#include "pass_scenes.hpp"
#include "reference/fluid_reference.hpp"

namespace sluice::vk::test {
namespace {

/// A cloud of which every third particle is without foam, and the others have some.
RigScene foamy(float radius, float scale) {
    RigScene scene = cloud(300, radius);
    scene.fluid.thickness_scale = scale;
    scene.fluid.foam = 4.0F;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> amount(0.0F, 1.0F);
    for (std::size_t i = 0; i < scene.positions.size() / 3; ++i) {
        scene.foam.push_back(i % 3 == 0 ? 0.0F : amount(random));
    }
    return scene;
}

TEST(SplatFoam, MatchesTheReferenceAtFullAndReducedResolutionBehindTheScene) {
    for (const float scale : {1.0F, 0.5F, 0.25F}) {
        RigScene scene = foamy(0.15F, scale);
        scene.encoding = SLUICE_DEPTH_LINEAR;
        for (std::uint32_t i = 0; i < scene.width * scene.height; ++i) {
            scene.host_depth.push_back(i % scene.width < 30 ? 2.0F : INFINITY);
        }
        const RigResult result = rendered(scene);
        const auto pixels = static_cast<std::uint32_t>(std::lround(1.0F / scale));
        const auto share = [&](std::size_t sphere, std::uint32_t x, std::uint32_t y, double middle, double ray) {
            const std::uint32_t u = std::min(x * pixels + pixels / 2, scene.width - 1);
            const std::uint32_t v = std::min(y * pixels + pixels / 2, scene.height - 1);
            const auto front = double{result.surface[std::size_t{v} * scene.width + u]};
            const double below = front > 1e29 ? 0.0 : std::max(middle - front, 0.0);
            return double{scene.foam[sphere]} * std::exp(-below * ray / (6.0 * double{scene.radius}));
        };
        const auto expected =
            referenceThickness(ReferenceFrame(scene), result.thickness_width, result.thickness_height, share);
        ASSERT_EQ(result.foam.size(), expected.size());
        const double radius = double{scene.radius} * double{scene.fluid.splat_radius};
        double largest = 0.0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            ASSERT_NEAR(double{result.foam[i]}, expected[i], 2e-2 * radius + 1e-5 * expected[i]) << "texel " << i;
            largest = std::max(largest, expected[i]);
        }
        EXPECT_GT(largest, 0.5 * radius);
    }
}

double decoded(double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

TEST(Foam, CoversTheWaterByItsSumAndIsLitByTheSkyAndTheSun) {
    RigScene scene = foamy(0.2F, 0.5F);
    const RigResult white = rendered(scene);
    scene.fluid.foam = 0.0F;
    const RigResult clear = rendered(scene);
    EXPECT_TRUE(clear.foam.empty()) << "who asks for none has no image of it";
    EXPECT_EQ(findPass(clear.plan, PassId::SplatFoam), nullptr);
    EXPECT_EQ(clear.surface, white.surface);
    const auto foamAt = [&](std::uint32_t x, std::uint32_t y) {
        const double u = (x + 0.5) / 2.0 - 0.5;
        const double v = (y + 0.5) / 2.0 - 0.5;
        double sum = 0.0;
        for (int corner = 0; corner < 4; ++corner) {
            const int i = static_cast<int>(std::floor(u)) + (corner & 1);
            const int j = static_cast<int>(std::floor(v)) + (corner >> 1);
            const double w = (1.0 - std::abs(u - i)) * (1.0 - std::abs(v - j));
            const int at_x = std::clamp(i, 0, static_cast<int>(white.thickness_width) - 1);
            const int at_y = std::clamp(j, 0, static_cast<int>(white.thickness_height) - 1);
            sum += w * double{white.foam[static_cast<std::size_t>(at_y) * white.thickness_width +
                                         static_cast<std::size_t>(at_x)]};
        }
        return sum;
    };
    std::size_t compared = 0;
    std::size_t covered = 0;
    for (std::size_t i = 0; i < white.colour.size(); ++i) {
        ASSERT_EQ(white.colour[i][3], clear.colour[i][3]) << "the outline is the water's";
        if (white.colour[i][3] == 0.0F) {
            continue;
        }
        const auto x = static_cast<std::uint32_t>(i % scene.width);
        const auto y = static_cast<std::uint32_t>(i / scene.width);
        const double cover = 1.0 - std::exp(-4.0 * foamAt(x, y) / (2.0 * double{scene.radius}));
        Vec3 n{double{white.normal[i][0]}, double{white.normal[i][1]}, double{white.normal[i][2]}};
        const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        double sun = 0.25;
        for (std::size_t k = 0; k < 3; ++k) {
            n[k] /= length;
            sun += 0.75 * n[k] * double{scene.sky.to_sun[k]};
        }
        // The camera looks along -z: its axes are the world's.
        const double up = (n[1] + 1.0) / std::sqrt(n[0] * n[0] + (n[1] + 1.0) * (n[1] + 1.0) + n[2] * n[2]);
        for (std::size_t k = 0; k < 3; ++k) {
            if (clear.colour[i][k] > 0.999F || white.colour[i][k] > 0.999F) {
                continue;  // a highlight that was cut off
            }
            // Half of it the horizon's.
            const double sky = double{scene.sky.horizon[k]} +
                               0.5 * (double{scene.sky.zenith[k]} - double{scene.sky.horizon[k]}) * std::sqrt(up);
            const double light = 0.85 * (sky + std::max(sun, 0.0) * 0.013 * double{scene.sky.sun_radiance[k]});
            const double expected = (1.0 - cover) * decoded(double{clear.colour[i][k]}) + cover * light;
            ASSERT_NEAR(decoded(double{white.colour[i][k]}), expected, 4e-3) << i;
            ++compared;
        }
        covered += cover > 0.5 ? 1U : 0U;
    }
    EXPECT_GT(compared, 1500U);
    EXPECT_GT(covered, 100U);
}

}  // namespace
}  // namespace sluice::vk::test
