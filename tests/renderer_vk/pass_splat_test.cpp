// SPDX-License-Identifier: MIT
// Splats against all spheres at all pixels in double precision.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "pass_scenes.hpp"
#include "reference/fluid_reference.hpp"

namespace sluice::vk::test {
namespace {

void expectMatchesReference(const RigScene& scene, double outline_pixels = 0.05) {
    const RigScene plain = withoutFilter(scene);
    const RigResult result = rendered(plain);
    const ReferenceFrame frame(plain);
    std::vector<double> slack;
    const std::vector<double> expected = referenceSplat(frame, &slack);
    ASSERT_EQ(result.depth_a.size(), expected.size());
    std::size_t compared = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const double found = double{result.depth_a[i]};
        ASSERT_FALSE(std::isnan(found));
        if (slack[i] < outline_pixels) {
            continue;
        }
        ++compared;
        ASSERT_EQ(found > 1e29, expected[i] > 1e29) << "coverage at texel " << i << ", slack " << slack[i];
        if (expected[i] < 1e29) {
            ASSERT_NEAR(found, expected[i], 2e-3 * frame.splat_radius + 4e-6 * expected[i]) << "texel " << i;
        }
    }
    EXPECT_GT(compared, expected.size() / 3) << "the outline's tolerance has eaten the test";
}

TEST(SplatDepth, MatchesEverySphereOfACloudThroughAnOffCentreProjection) {
    expectMatchesReference(cloud(300, 0.1F));
}

TEST(SplatDepth, MatchesSubPixelSpheres) {
    expectMatchesReference(cloud(4000, 0.004F), 0.02);
}

TEST(SplatDepth, MatchesHugeSpheres) {
    expectMatchesReference(cloud(6, 0.9F));
}

TEST(SplatDepth, ShowsTheNearPlaneFromInsideASphere) {
    RigScene scene = withoutFilter(emptyScene());
    scene.positions = {0.0F, 0.0F, -0.05F};
    scene.radius = 1.0F;
    const RigResult result = rendered(scene);
    for (const float depth : result.depth_a) {
        ASSERT_EQ(depth, scene.camera.near_plane);
    }
}

TEST(SplatDepth, DrawsNothingBehindTheCameraBeyondTheFarPlaneOrAtNaN) {
    RigScene scene = withoutFilter(emptyScene());
    scene.positions = {0.0F, 0.0F, 1.0F, 0.0F, 0.0F, -30.0F, NAN, 0.0F, -2.0F, 0.0F, INFINITY, -2.0F};
    const RigResult result = rendered(scene);
    EXPECT_TRUE(std::ranges::all_of(result.depth_a, [](float depth) { return depth == 1e30F; }));
    EXPECT_TRUE(std::ranges::all_of(result.depth, [](float depth) { return depth == 1.0F; }));
}

TEST(SplatDepth, IsTheSameBitForBitInAnyOrderOfParticles) {
    RigScene scene = withoutFilter(cloud(500, 0.08F));
    const RigResult forwards = rendered(scene);
    std::vector<float> reversed;
    for (std::size_t i = scene.positions.size(); i >= 3; i -= 3) {
        reversed.insert(reversed.end(), {scene.positions[i - 3], scene.positions[i - 2], scene.positions[i - 1]});
    }
    scene.positions = reversed;
    EXPECT_EQ(rendered(scene).depth_a, forwards.depth_a);
}

void expectThicknessMatches(const RigScene& scene) {
    RigScene plain = withoutFilter(scene);
    plain.fluid.thickness_blur = 0.0F;
    const RigResult result = rendered(plain);
    const auto expected = referenceThickness(ReferenceFrame(plain), result.thickness_width, result.thickness_height);
    ASSERT_EQ(result.thickness.size(), expected.size());
    const double radius = double{plain.radius} * double{plain.fluid.splat_radius};
    double largest = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        // Near an outline the chord falls off as a square root: a rounding of the distance shows as its root.
        ASSERT_NEAR(double{result.thickness[i]}, expected[i], 2e-2 * radius + 1e-5 * expected[i]) << "texel " << i;
        largest = std::max(largest, expected[i]);
    }
    EXPECT_GT(largest, 0.5 * radius);
}

TEST(SplatThickness, MatchesACloudAtFullAndReducedResolution) {
    for (const float scale : {1.0F, 0.5F, 0.25F}) {
        RigScene scene = cloud(200, 0.12F);
        scene.fluid.thickness_scale = scale;
        expectThicknessMatches(scene);
    }
}

/// Spheres on either side of where a point could no longer cover them, in a picture wider than any point on llvmpipe.
RigScene nearAndFar() {
    RigScene scene = emptyScene();
    scene.width = 402;
    scene.height = 258;
    scene.radius = 0.1F;
    for (const float depth : {0.18F, 0.25F, 0.29F, 0.32F, 0.36F, 0.5F, 0.9F}) {
        scene.positions.insert(scene.positions.end(), {0.6F * depth - 0.2F, 0.3F * depth - 0.1F, -depth});
    }
    return scene;
}

TEST(SplatDepth, MatchesSpheresWiderThanAnyPoint) {
    expectMatchesReference(nearAndFar());
}

TEST(SplatThickness, CountsASphereOnceWhetherItIsAPointOrATriangle) {
    for (const float scale : {1.0F, 0.5F}) {
        RigScene scene = nearAndFar();
        scene.fluid.thickness_scale = scale;
        expectThicknessMatches(scene);
    }
}

TEST(SplatThickness, CountsOnlyWhatIsInFrontOfTheSceneInEitherEncoding) {
    RigScene scene = cloud(200, 0.15F);
    scene.encoding = SLUICE_DEPTH_LINEAR;
    for (std::uint32_t i = 0; i < scene.width * scene.height; ++i) {
        scene.host_depth.push_back(i % scene.width < 30 ? 2.0F : INFINITY);
    }
    expectThicknessMatches(scene);
    scene.encoding = SLUICE_DEPTH_WINDOW;
    const ReferenceFrame frame(scene);
    for (float& depth : scene.host_depth) {
        depth = std::isinf(depth) ? 1.0F : static_cast<float>(0.5 + 0.5 * (frame.a + frame.b / double{depth}));
    }
    expectThicknessMatches(scene);
}

TEST(SplatThickness, OfABulkSlabIsItsMetres) {
    RigScene scene = slab(12, 10, 0.05F, 2.0F);
    const RigResult result = rendered(scene);
    const double metres = 10 * 2 * 0.05;
    double sum = 0;
    int count = 0;
    for (std::uint32_t y = result.thickness_height / 2 - 4; y < result.thickness_height / 2 + 4; ++y) {
        for (std::uint32_t x = result.thickness_width / 2 - 4; x < result.thickness_width / 2 + 4; ++x, ++count) {
            sum += double{result.thickness[y * result.thickness_width + x]};
        }
    }
    EXPECT_NEAR(sum / count, metres, 0.05 * metres);
}

}  // namespace
}  // namespace sluice::vk::test
