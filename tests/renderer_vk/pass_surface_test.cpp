// SPDX-License-Identifier: MIT
// Normals and the blur of thickness.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "pass_scenes.hpp"
#include "reference/fluid_reference.hpp"
#include "simulation/depth_field.hpp"

namespace sluice::vk::test {
namespace {

double degreesBetween(const std::array<float, 4>& found, const Vec3& expected) {
    const double x = double{found[0]};
    const double y = double{found[1]};
    const double z = double{found[2]};
    const double length = std::sqrt(x * x + y * y + z * z);
    const Vec3 cross{y * expected[2] - z * expected[1], z * expected[0] - x * expected[2],
                     x * expected[1] - y * expected[0]};
    const double sine = std::sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]) / length;
    const double cosine = (x * expected[0] + y * expected[1] + z * expected[2]) / length;
    return std::atan2(sine, cosine) * 180 / std::numbers::pi;
}

void expectNormalsMatch(const RigScene& scene) {
    const RigResult result = rendered(scene);
    const ReferenceFrame frame(scene);
    const auto expected = referenceNormals(frame, result.surface);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_EQ(result.normal[i][3], result.surface[i] < 1e29F ? 1.0F : 0.0F);
        if (result.surface[i] < 1e29F) {
            // The difference of two floats of this depth over one pixel's footprint, and a half float's step.
            const double degrees = degreesBetween(result.normal[i], expected[i]);
            ASSERT_LT(degrees, 0.12) << "texel " << i;
            const Vec3 ray =
                frame.ray(static_cast<double>(i % scene.width) + 0.5, static_cast<double>(i / scene.width) + 0.5);
            const double facing = double{result.normal[i][0]} * ray[0] + double{result.normal[i][1]} * ray[1] -
                                  double{result.normal[i][2]};
            ASSERT_LE(facing, 1e-3) << "texel " << i << " faces away";
        }
    }
}

TEST(Normals, MatchTheReferenceOnAFilteredCloud) {
    expectNormalsMatch(cloud(400, 0.12F));
}
TEST(Normals, MatchTheReferenceOnIsolatedPixels) {
    expectNormalsMatch(withoutFilter(cloud(3000, 0.01F)));
}

TEST(Normals, OfASphereAreWithinADegreeAndAHalfAwayFromItsOutline) {
    RigScene scene = withoutFilter(emptyScene());
    scene.width = 201;
    scene.height = 129;
    scene.radius = 0.5F;
    scene.positions = {0.2F, -0.1F, -3.0F};
    const RigResult result = rendered(scene);
    const ReferenceFrame frame(scene);
    int compared = 0;
    for (std::size_t i = 0; i < result.surface.size(); ++i) {
        if (result.surface[i] > 1e29F) {
            continue;
        }
        const Vec3 ray =
            frame.ray(static_cast<double>(i % scene.width) + 0.5, static_cast<double>(i / scene.width) + 0.5);
        Vec3 truth{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            truth[axis] = (ray[axis] * double{result.surface[i]} - frame.eyes[0][axis]) / frame.splat_radius;
        }
        const double facing = -(truth[0] * ray[0] + truth[1] * ray[1] + truth[2] * ray[2]);
        if (facing > 0.4) {
            ASSERT_LT(degreesBetween(result.normal[i], truth), 1.5) << "texel " << i;
            ++compared;
        }
    }
    EXPECT_GT(compared, 500);
}

void expectBlurMatches(RigScene scene) {
    RigScene sharp = scene;
    sharp.fluid.thickness_blur = 0.0F;
    const RigResult raw = rendered(sharp);
    const RigResult blurred = rendered(scene);
    const auto expected = referenceBlur(ReferenceFrame(scene), {raw.thickness.begin(), raw.thickness.end()},
                                        raw.thickness_width, raw.thickness_height, blurred.surface);
    const double largest = double{*std::ranges::max_element(raw.thickness)};
    ASSERT_GT(largest, 0);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_NEAR(double{blurred.thickness[i]}, expected[i], 1e-5 * largest) << "texel " << i;
    }
}

TEST(BlurThickness, MatchesTheReference) {
    expectBlurMatches(cloud(300, 0.12F));
    RigScene wide = cloud(60, 0.4F);
    wide.fluid.thickness_blur = 6.0F;
    wide.fluid.thickness_scale = 1.0F;
    expectBlurMatches(wide);
}

TEST(BlurThickness, DoesNotThinTheOutlineOfASlab) {
    RigScene scene = slab(3, 4, 0.1F, 2.5F);
    scene.fluid.thickness_blur = 2.0F;
    const RigResult blurred = rendered(scene);
    RigScene sharp = scene;
    sharp.fluid.thickness_blur = 0.0F;
    const RigResult raw = rendered(sharp);
    // Zeros beside the outline must not be averaged in: the mean inside may not drop.
    double before = 0;
    double after = 0;
    for (std::size_t i = 0; i < raw.thickness.size(); ++i) {
        if (raw.thickness[i] > 0.0F) {
            before += double{raw.thickness[i]};
            after += double{blurred.thickness[i]};
        }
    }
    EXPECT_GT(after, 0.97 * before);
}

/// What is captured against doubles: of window depths and of metres, reduced or not, with a last texel that reaches
/// out.
TEST(CaptureDepth, KeepsTheNearestDepthInMetresAndTheCamera) {
    constexpr double kNear = 0.125;  // floats, too
    constexpr double kFar = 40.0;
    for (const SluiceDepthEncoding encoding : {SLUICE_DEPTH_WINDOW, SLUICE_DEPTH_LINEAR}) {
        for (const std::uint32_t scale : {1U, 2U, 3U}) {
            RigScene scene = emptyScene();
            scene.width = 37;
            scene.height = 22;
            scene.encoding = encoding;
            scene.capture_scale = scale;
            scene.camera = perspective(1.0, 37.0 / 22.0, 0.125F, 40.0F, {0.1, -0.2});
            lookAt(scene.camera, {1, 2, 3}, {0, 0.5, 0});
            std::vector<float> metres(37 * 22);
            for (std::size_t i = 0; i < metres.size(); ++i) {
                const double depth = 0.2 + static_cast<double>(i * 7919 % 997) * 0.01;
                const bool empty = i % 5 == 0;
                const double window = kFar / (kFar - kNear) * (1.0 - kNear / depth);
                const bool linear = encoding == SLUICE_DEPTH_LINEAR;
                scene.host_depth.push_back(
                    linear ? (empty ? std::numeric_limits<float>::infinity() : static_cast<float>(depth))
                           : (empty ? 1.0F : static_cast<float>(window)));
                // Of what the image really holds.
                const auto raw = double{scene.host_depth.back()};
                const double seen = linear ? raw : 1.0 / (1.0 / kNear - raw * (kFar - kNear) / kFar / kNear);
                metres[i] = empty ? 1e30F : static_cast<float>(seen);
            }
            DepthView camera;
            std::copy_n(&scene.camera.view[0], 16, camera.view.begin());
            std::copy_n(&scene.camera.projection[0], 16, camera.projection.begin());
            camera.near_plane = 0.125F;
            const DepthField expected = depthField(camera, 37, 22, scale, 0.25F, metres);
            const RigResult result = rendered(scene);
            DepthHeader header;
            ASSERT_EQ(result.captured.size(), sizeof header / sizeof(float) + expected.depth.size());
            std::memcpy(static_cast<void*>(&header), result.captured.data(), sizeof header);
            const DepthHeader wanted = depthHeader(expected);
            EXPECT_EQ(std::memcmp(&header, &wanted, sizeof header), 0);
            for (std::size_t i = 0; i < expected.depth.size(); ++i) {
                const float found = result.captured[sizeof header / sizeof(float) + i];
                ASSERT_NEAR(double{found} / double{expected.depth[i]}, 1.0, 2e-5) << i << " " << scale;
            }
        }
    }
}

}  // namespace
}  // namespace sluice::vk::test
