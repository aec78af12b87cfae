// SPDX-License-Identifier: MIT
// The narrow-range filter: against its definition, and by what it must leave alone.
#include <algorithm>
#include <cmath>

#include "pass_scenes.hpp"
#include "reference/fluid_reference.hpp"

namespace sluice::vk::test {
namespace {

/// Filters what the splat of the same scene gave, both on the device and in the reference.
void expectMatchesReference(const RigScene& scene) {
    const RigResult raw = rendered(withoutFilter(scene));
    const RigResult filtered = rendered(scene);
    const ReferenceFrame frame(scene);
    const auto expected = referenceFilter(frame, {raw.depth_a.begin(), raw.depth_a.end()});
    std::size_t beyond = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const double found = double{filtered.surface[i]};
        ASSERT_FALSE(std::isnan(found));
        ASSERT_EQ(found > 1e29, double{raw.depth_a[i]} > 1e29) << "the filter changed the outline at " << i;
        // A sample on the very edge of the range may fall on either side of it by rounding: counted, not bounded.
        beyond += expected[i] < 1e29 && std::abs(found - expected[i]) > 3e-6 * expected[i] ? 1U : 0U;
    }
    EXPECT_LE(beyond, expected.size() / 500);
}

TEST(Filter, MatchesTheReferenceOnACloudWithDiscontinuities) {
    expectMatchesReference(cloud(400, 0.12F));
}

TEST(Filter, MatchesTheReferenceWhenTheCapCutsTheKernel) {
    RigScene scene = cloud(60, 0.5F);
    scene.fluid.filter_max_pixels = 9;
    expectMatchesReference(scene);
}

TEST(Filter, MatchesTheReferenceWithOneIterationOfAWideKernel) {
    RigScene scene = cloud(300, 0.2F);
    scene.fluid.filter_iterations = 1;
    scene.fluid.filter_sigma = 3.0F;
    scene.fluid.filter_max_pixels = kMaxFilterPixels;
    expectMatchesReference(scene);
}

TEST(Filter, LeavesAPlaneThatFillsTheScreenWhereItWas) {
    // Inside a sphere the depth is the near plane's everywhere: a plane without any rounding of its own.
    RigScene scene = emptyScene();
    scene.positions = {0.0F, 0.0F, -0.05F};
    scene.radius = 1.0F;
    for (const float depth : rendered(scene).surface) {
        ASSERT_NEAR(depth, scene.camera.near_plane, 1e-6F * scene.camera.near_plane);
    }
}

TEST(Filter, GivesAMirroredPictureForAMirroredScene) {
    RigScene scene = cloud(200, 0.15F);
    scene.camera = perspective(1.0, 67.0 / 43.0, 0.1F, 20.0F);
    for (std::size_t i = 0, end = scene.positions.size(); i < end; i += 3) {
        const float x = scene.positions[i];
        const float y = scene.positions[i + 1];
        const float z = scene.positions[i + 2];
        scene.positions.insert(scene.positions.end(), {-x, y, z});
    }
    const RigResult raw = rendered(withoutFilter(scene));
    const RigResult filtered = rendered(scene);
    const auto mirrored = [&](std::size_t i) { return i - i % scene.width + (scene.width - 1 - i % scene.width); };
    for (std::size_t i = 0; i < raw.depth_a.size(); ++i) {
        const float a = raw.depth_a[i];
        if (a > 1e29F || raw.depth_a[mirrored(i)] > 1e29F) {
            continue;
        }
        ASSERT_NEAR(filtered.surface[i], filtered.surface[mirrored(i)], 1e-3F * scene.radius + 4e-6F * a) << i;
    }
}

TEST(Filter, SmoothsTheBumpsOfASlab) {
    RigScene scene = slab(12, 4, 0.05F, 2.0F);
    const auto roughness = [&](const std::vector<float>& depth) {
        double sum = 0;
        for (std::uint32_t y = 15; y < 28; ++y) {
            for (std::uint32_t x = 25; x < 42; ++x) {
                const std::size_t i = std::size_t{y} * scene.width + x;
                sum += std::abs(double{depth[i + 1]} - 2 * double{depth[i]} + double{depth[i - 1]});
            }
        }
        return sum;
    };
    EXPECT_LT(roughness(rendered(scene).surface), 0.1 * roughness(rendered(withoutFilter(scene)).surface));
}

}  // namespace
}  // namespace sluice::vk::test
