// SPDX-License-Identifier: MIT
// Splats that are ellipsoids, against all of them at all pixels in double precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pass_scenes.hpp"
#include "reference/fluid_reference.hpp"

namespace sluice::vk::test {
namespace {

using Axes = std::array<double, 3>;

/// A centre, three lengths, and a rotation out of a quaternion that need not be unit.
void add(RigScene& scene, std::array<float, 3> centre, const Axes& lengths, std::array<double, 4> turn) {
    const double norm = std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]);
    const double x = turn[0] / norm;
    const double y = turn[1] / norm;
    const double z = turn[2] / norm;
    const double w = turn[3] / norm;
    const std::array<Vec3, 3> axes{{{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
                                    {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
                                    {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}}};
    scene.ellipsoids.insert(scene.ellipsoids.end(), centre.begin(), centre.end());
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = a; b < 3; ++b) {
            double sum = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                sum += lengths[k] * axes[k][a] * axes[k][b];
            }
            scene.ellipsoids.push_back(static_cast<float>(sum));
        }
    }
    scene.longest = std::max({scene.longest, static_cast<float>(lengths[0]), static_cast<float>(lengths[1]),
                              static_cast<float>(lengths[2])});
}

/// Everywhere: in front, off screen, behind, across the near plane; flat and long ones of all directions.
RigScene shapes(std::uint32_t count, float radius, double ratio, float nearest = 0.4F) {
    RigScene scene = withoutFilter(emptyScene());
    scene.radius = radius;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> x(-2.5F, 2.5F);
    std::uniform_real_distribution<float> z(-6.0F, nearest);
    std::uniform_real_distribution<double> q(-1.0, 1.0);
    for (std::uint32_t i = 0; i < count; ++i) {
        const double flat = std::cbrt(ratio);
        const double keen = std::pow(ratio, 1.5 / 3.0);
        const std::array<Axes, 3> kinds{{{flat, flat, flat / ratio},
                                         {flat * flat, flat / ratio * flat, flat * flat / ratio},
                                         {keen, 1.0, 1.0 / keen}}};
        add(scene, {x(random), x(random), z(random)}, kinds.at(i % 3), {q(random), q(random), q(random), q(random)});
    }
    return scene;
}

void expectDepth(const RigScene& scene, double least_compared, double outline_pixels = 0.05) {
    const RigResult result = rendered(scene);
    const ReferenceFrame frame(scene);
    std::vector<double> slack;
    const std::vector<double> expected = referenceSplat(frame, &slack);
    ASSERT_EQ(result.depth_a.size(), expected.size());
    std::size_t compared = 0;
    std::size_t covered = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const auto found = double{result.depth_a[i]};
        ASSERT_FALSE(std::isnan(found));
        if (slack[i] < outline_pixels) {
            continue;
        }
        ++compared;
        ASSERT_EQ(found > 1e29, expected[i] > 1e29) << "coverage at texel " << i << ", slack " << slack[i];
        if (expected[i] < 1e29) {
            ++covered;
            ASSERT_NEAR(found, expected[i], 3e-3 * frame.splat_radius + 4e-6 * expected[i]) << "texel " << i;
        }
    }
    EXPECT_GT(static_cast<double>(compared), least_compared * static_cast<double>(expected.size()));
    EXPECT_GT(covered, 10U) << "an empty picture compares nothing";
}

TEST(EllipsoidDepth, MatchesACloudOfFlatAndLongOnesThroughAnOffCentreProjection) {
    expectDepth(shapes(300, 0.1F, 4.0), 0.3);
}

TEST(EllipsoidDepth, MatchesThinOnesOfOneToTen) {
    expectDepth(shapes(150, 0.15F, 10.0), 0.3);
}

TEST(EllipsoidDepth, MatchesThoseSmallerThanAPixel) {
    expectDepth(shapes(4000, 0.004F, 4.0, -2.0F), 0.3, 0.004);
}

TEST(EllipsoidDepth, MatchesHugeOnesThatTheNearPlaneCutsAndTheEyeIsIn) {
    for (const double ratio : {3.0, 10.0}) {
        RigScene scene = shapes(6, 0.9F, ratio);
        add(scene, {0.05F, 0.1F, 0.2F}, {1.2, 0.4, 0.9}, {0.3, 0.2, 0.1, 1});
        expectDepth(scene, 0.2);
    }
}

TEST(EllipsoidDepth, OfOnesWithoutAStretchIsThatOfSpheres) {
    RigScene spheres = withoutFilter(cloud(200, 0.1F));
    RigScene scene = spheres;
    for (std::size_t i = 0; i < spheres.positions.size(); i += 3) {
        add(scene, {spheres.positions[i], spheres.positions[i + 1], spheres.positions[i + 2]}, {1, 1, 1}, {1, 2, 3, 4});
    }
    const RigResult round = rendered(spheres);
    const RigResult found = rendered(scene);
    std::size_t other = 0;
    for (std::size_t i = 0; i < round.depth_a.size(); ++i) {
        const bool same = std::abs(double{round.depth_a[i]} - double{found.depth_a[i]}) < 1e-4 ||
                          (round.depth_a[i] > 1e29F && found.depth_a[i] > 1e29F);
        other += same ? 0 : 1;
    }
    EXPECT_LE(other, round.depth_a.size() / 200) << "but for outlines";
}

TEST(EllipsoidDepth, DrawsNothingBehindTheCameraBeyondTheFarPlaneOrAtNaN) {
    RigScene scene = withoutFilter(emptyScene());
    const std::array<double, 4> turn{1, 0, 2, 0};
    for (const std::array<float, 3>& at : {std::array{0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, -30.0F}, {NAN, 0.0F, -2.0F}}) {
        add(scene, at, {2, 0.7, 0.7}, turn);
    }
    scene.ellipsoids.resize(scene.ellipsoids.size() + 9, 0.0F);  // a slot that nobody has written
    const RigResult result = rendered(scene);
    EXPECT_TRUE(std::all_of(result.depth_a.begin(), result.depth_a.end(), [](float d) { return d == 1e30F; }));
}

/// In a picture wider than any point on llvmpipe, some near enough to be triangles.
TEST(EllipsoidThickness, CountsEachOnceWhetherItIsAPointOrATriangle) {
    RigScene scene = withoutFilter(emptyScene());
    scene.width = 402;
    scene.height = 258;
    scene.radius = 0.06F;
    scene.fluid.thickness_blur = 0.0F;
    for (const float depth : {0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 0.8F, 1.3F}) {
        add(scene, {0.6F * depth - 0.2F, 0.3F * depth - 0.1F, -depth}, {2.0, 1.0, 0.5}, {depth, 0.3, 1.0, 0.7});
    }
    expectDepth(scene, 0.3);
    for (const float scale : {1.0F, 0.5F}) {
        scene.fluid.thickness_scale = scale;
        const RigResult result = rendered(scene);
        const auto expected =
            referenceThickness(ReferenceFrame(scene), result.thickness_width, result.thickness_height);
        ASSERT_EQ(result.thickness.size(), expected.size());
        const double radius = double{scene.radius} * double{scene.fluid.splat_radius};
        for (std::size_t i = 0; i < expected.size(); ++i) {
            ASSERT_NEAR(double{result.thickness[i]}, expected[i], 3e-2 * radius + 1e-5 * expected[i]) << "texel " << i;
        }
        EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0.3 * radius);
    }
}

}  // namespace
}  // namespace sluice::vk::test
