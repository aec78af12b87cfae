// SPDX-License-Identifier: MIT
// The lists of tiles: no pixel of fluid is missed, and nothing of an earlier frame is left outside them.
#include <algorithm>
#include <array>
#include <cmath>

#include "pass_scenes.hpp"

namespace sluice::vk::test {
namespace {

/// Spheres of about a pixel where tiles begin and end, in a picture whose last tiles are one texel wide.
RigScene specks() {
    RigScene scene = emptyScene();
    scene.width = 65;
    scene.height = 49;
    scene.camera = perspective(1.0, 65.0 / 49.0, 0.1F, 20.0F);
    const double focal = 49 / (2 * std::tan(0.5));
    const double distance = 2;
    scene.radius = static_cast<float>(0.6 * distance / focal / double{scene.fluid.splat_radius});
    for (const double y : {0.5, 15.5, 16.5, 31.5, 48.5}) {
        for (const double x : {0.5, 15.5, 32.5, 47.5, 64.5}) {
            const double sx = (x - 32.5) / focal * distance;
            const double sy = (y - 24.5) / focal * distance;
            scene.positions.insert(scene.positions.end(),
                                   {static_cast<float>(sx), static_cast<float>(sy), static_cast<float>(-distance)});
        }
    }
    return scene;
}

TEST(Tiles, NoPixelIsMissed) {
    RigScene scene = specks();
    scene.outputs = SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL) | SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_THICKNESS);
    const RigResult raw = rendered(withoutFilter(scene));
    const RigResult result = rendered(scene);
    std::size_t fluid = 0;
    for (std::size_t i = 0; i < raw.depth_a.size(); ++i) {
        const bool inside = raw.depth_a[i] < 1e29F;
        fluid += inside ? 1U : 0U;
        ASSERT_EQ(result.surface[i] < 1e29F, inside) << i;
        ASSERT_EQ(result.normal[i][3], inside ? 1.0F : 0.0F) << i;
        ASSERT_EQ(result.depth[i] < 1.0F, inside) << i;
        ASSERT_EQ(result.normal_out[i][3], inside ? 1.0F : 0.0F) << i;
    }
    EXPECT_GE(fluid, 25U);
    EXPECT_LT(fluid, 200U);
}

TEST(Tiles, NothingOfTheLastFrameIsLeftOutside) {
    const RigScene scene = specks();
    const RigResult fresh = rendered(scene);
    RigScene full = scene;
    full.positions = {0.0F, 0.0F, -0.05F};
    full.radius = 1.0F;
    ASSERT_EQ(rendered(full).plan, fresh.plan) << "the images are to be used again";
    const RigResult again = rendered(scene);
    EXPECT_EQ(again.surface, fresh.surface);
    EXPECT_EQ(again.normal, fresh.normal);
    EXPECT_EQ(again.thickness, fresh.thickness);
    EXPECT_EQ(again.colour, fresh.colour);
    EXPECT_EQ(again.depth, fresh.depth);
}

TEST(Tiles, AnEmptyPictureSaysNoFluid) {
    RigScene scene = specks();
    scene.positions = {0.0F, 0.0F, 3.0F};  // behind the camera: there are particles, but no tile
    scene.outputs = SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL) | SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_THICKNESS);
    const RigResult result = rendered(scene);
    constexpr std::array<float, 4> kZero{};
    EXPECT_TRUE(std::ranges::all_of(result.surface, [](float depth) { return depth == 1e30F; }));
    EXPECT_TRUE(std::ranges::all_of(result.depth, [](float depth) { return depth == 1.0F; }));
    EXPECT_TRUE(std::ranges::all_of(result.colour, [&](const auto& texel) { return texel == kZero; }));
    EXPECT_TRUE(std::ranges::all_of(result.normal_out, [&](const auto& texel) { return texel == kZero; }));
    EXPECT_TRUE(std::ranges::all_of(result.thickness_out, [](float metres) { return metres == 0.0F; }));
}

}  // namespace
}  // namespace sluice::vk::test
