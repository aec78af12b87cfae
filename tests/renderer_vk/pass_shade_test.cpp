// SPDX-License-Identifier: MIT
// Shading against its formulas in double precision, and what the host may rely on.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "pass_scenes.hpp"
#include "reference/fluid_reference.hpp"

namespace sluice::vk::test {
namespace {

double encoded(double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}
double decoded(double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

TEST(Shade, EmptyFrameHasNoCoverageAndDepthOne) {
    RigScene scene = emptyScene();
    scene.outputs = ~0U;
    const RigResult result = rendered(scene);
    for (std::size_t i = 0; i < result.depth.size(); ++i) {
        ASSERT_EQ(result.colour[i][3], 0.0F);
        ASSERT_EQ(result.depth[i], 1.0F);
        ASSERT_EQ(result.normal_out[i][3], 0.0F);
        ASSERT_EQ(result.thickness_out[i], 0.0F);
    }
}

TEST(Shade, WindowDepthIsThatOfTheProjection) {
    const RigScene scene = cloud(300, 0.15F);
    const RigResult result = rendered(scene);
    const ReferenceFrame frame(scene);
    for (std::size_t i = 0; i < result.depth.size(); ++i) {
        const double expected =
            result.surface[i] > 1e29F ? 1.0 : 0.5 + 0.5 * (frame.a + frame.b / double{result.surface[i]});
        ASSERT_NEAR(double{result.depth[i]}, expected, 1e-6) << i;
    }
}

TEST(Shade, IsHiddenWhereTheSceneIsInFront) {
    RigScene scene = cloud(300, 0.15F);
    scene.encoding = SLUICE_DEPTH_LINEAR;
    scene.host_depth.assign(std::size_t{scene.width} * scene.height, 0.11F);
    scene.outputs = ~0U;
    const RigResult result = rendered(scene);
    for (std::size_t i = 0; i < result.depth.size(); ++i) {
        if (result.surface[i] > 0.11F) {
            ASSERT_EQ(result.colour[i][3], 0.0F) << i;
            ASSERT_EQ(result.depth[i], 1.0F) << i;
        }
    }
}

TEST(Shade, EveryOutputIsFiniteAndInRangeOnHardScenes) {
    for (const float radius : {0.004F, 0.1F, 0.9F}) {
        RigScene scene = cloud(500, radius);
        scene.outputs = ~0U;
        const RigResult result = rendered(scene);
        for (std::size_t i = 0; i < result.depth.size(); ++i) {
            for (const float channel : result.colour[i]) {
                ASSERT_TRUE(channel >= 0.0F && channel <= 1.0F) << i;
            }
            ASSERT_TRUE(result.depth[i] >= 0.0F && result.depth[i] <= 1.0F) << i;
            ASSERT_TRUE(std::isfinite(result.thickness_out[i]) && result.thickness_out[i] >= 0.0F) << i;
        }
    }
}

TEST(Shade, AFlatBackgroundIsAbsorbedByBeersLawAndReflectedBySchlick) {
    RigScene scene = cloud(400, 0.2F);
    scene.camera = perspective(1.0, 67.0 / 43.0, 0.1F, 20.0F, {0.13, -0.21});
    scene.outputs = ~0U;
    const std::array<double, 3> grey{decoded(128 / 255.0), decoded(128 / 255.0), decoded(128 / 255.0)};
    const RigResult result = rendered(scene);
    const ReferenceFrame frame(scene);
    const SluiceFluid& fluid = scene.fluid;
    const double ior = double{fluid.index_of_refraction};
    const double f0 = std::pow((ior - 1) / (ior + 1), 2);
    const auto schlick = [&](double cosine) { return f0 + (1 - f0) * std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5); };
    std::size_t compared = 0;
    for (std::size_t i = 0; i < result.depth.size(); ++i) {
        if (result.colour[i][3] == 0.0F) {
            continue;
        }
        const Vec3 ray =
            frame.ray(static_cast<double>(i % scene.width) + 0.5, static_cast<double>(i / scene.width) + 0.5);
        const double length = std::sqrt(ray[0] * ray[0] + ray[1] * ray[1] + 1);
        Vec3 v{-ray[0] / length, -ray[1] / length, 1 / length};
        Vec3 n{double{result.normal[i][0]}, double{result.normal[i][1]}, double{result.normal[i][2]}};
        const double n_length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        double nv = 0;
        double nl = 0;
        double h_squared = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            n[k] /= n_length;
            nv += n[k] * v[k];
            nl += n[k] * double{scene.sky.to_sun[k]};
            h_squared += std::pow(v[k] + double{scene.sky.to_sun[k]}, 2);
        }
        double nh = 0;
        double vh = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double h = (v[k] + double{scene.sky.to_sun[k]}) / std::sqrt(h_squared);
            nh += n[k] * h;
            vh += v[k] * h;
        }
        // The view matrix is the identity here: the mirrored direction in the world is that of the eye.
        const double up = 2 * nv * n[1] - v[1];
        const double fresnel = schlick(nv);
        const double lobe = nl > 0 ? std::pow(std::max(nh, 1e-6), double{fluid.specular_power}) * schlick(vh) : 0.0;
        const double path = double{result.thickness_out[i]};
        for (std::size_t k = 0; k < 3; ++k) {
            const double horizon = double{scene.sky.horizon[k]};
            const double sky = up >= 0 ? horizon + (double{scene.sky.zenith[k]} - horizon) * std::sqrt(up)
                                       : horizon + (double{scene.sky.ground[k]} - horizon) * std::min(1.0, -4 * up);
            const double transmitted = std::exp(-double{fluid.absorption[k]} * path);
            const double expected =
                fresnel * sky + lobe * double{scene.sky.sun_radiance[k]} +
                (1 - fresnel) * (grey[k] * transmitted + double{fluid.scatter_colour[k]} * (1 - transmitted));
            // Where the highlight is steep the normal's rounding shows: the bound grows with the lobe.
            ASSERT_NEAR(double{result.colour[i][k]}, encoded(expected), 2e-3 + 5e-3 * lobe * 40) << i;
        }
        ++compared;
    }
    EXPECT_GT(compared, 500U);
}

TEST(Shade, WithoutThicknessOrReflectionTheBackgroundComesThroughUnchanged) {
    RigScene scene = slab(8, 2, 0.1F, 2.0F);
    std::fill_n(scene.fluid.absorption, 3, 0.0F);
    std::fill_n(scene.fluid.scatter_colour, 3, 0.0F);
    std::fill_n(scene.sky.sun_radiance, 3, 0.0F);
    scene.fluid.reflection = 0;
    const RigResult result = rendered(scene);
    const std::size_t middle = std::size_t{scene.height / 2} * scene.width + scene.width / 2;
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(double{result.colour[middle][k]}, 128 / 255.0, 1e-3);
    }
    EXPECT_EQ(result.colour[middle][3], 1.0F);
}

TEST(Shade, APillarInFrontLeavesNoGhostInTheRefraction) {
    RigScene scene = slab(10, 4, 0.1F, 2.0F);
    scene.encoding = SLUICE_DEPTH_LINEAR;
    std::fill_n(scene.sky.sun_radiance, 3, 0.0F);
    scene.fluid.reflection = 0;
    std::fill_n(scene.fluid.scatter_colour, 3, 0.0F);
    for (std::uint32_t i = 0; i < scene.width * scene.height; ++i) {
        const bool pillar = i % scene.width >= 30 && i % scene.width < 36;
        scene.host_depth.push_back(pillar ? 1.0F : 8.0F);
        const std::uint8_t red = pillar ? 255 : 0;
        const std::uint8_t blue = pillar ? 0 : 200;
        scene.host_colour.insert(scene.host_colour.end(), {red, 0, blue, 255});
    }
    const RigResult result = rendered(scene);
    for (std::size_t i = 0; i < result.colour.size(); ++i) {
        if (result.colour[i][3] > 0.0F) {
            ASSERT_LT(result.colour[i][0], 0.02F) << "the pillar's red at texel " << i;
        }
    }
}

/// The map of plugin.h in a direction: column c looks along longitude 2 pi c / width from -z towards +x, row r along
/// colatitude pi (r + 1/2) / height from the zenith. Each texel counts by its distance, round the circle in longitude;
/// beyond the outer rows there is only the outer row.
Vec3 mapAt(const RigScene& scene, const Vec3& direction) {
    const double width = scene.environment_width;
    const double height = scene.environment_height;
    const double x = std::atan2(direction[0], -direction[2]) / (2 * std::numbers::pi) * width;
    const double y =
        std::clamp(std::acos(std::clamp(direction[1], -1.0, 1.0)) / std::numbers::pi * height, 0.5, height - 0.5);
    Vec3 sum{};
    for (std::uint32_t row = 0; row < scene.environment_height; ++row) {
        for (std::uint32_t column = 0; column < scene.environment_width; ++column) {
            const double across = std::abs(std::remainder(x - column, width));
            const double down = std::abs(y - (row + 0.5));
            const double weight = std::max(0.0, 1 - across) * std::max(0.0, 1 - down);
            for (std::size_t k = 0; k < 3; ++k) {
                sum[k] += weight * double{scene.environment[(row * scene.environment_width + column) * 3 + k]};
            }
        }
    }
    return sum;
}

/// Spheres all round the origin, reflecting a map of which no two texels are alike; nothing comes through them.
RigScene mirrorBalls(std::array<double, 3> look_at) {
    RigScene scene = emptyScene();
    scene.outputs = ~0U;
    scene.radius = 0.25F;
    lookAt(scene.camera, {0, 0, 0}, look_at);
    std::mt19937 random(11);
    std::uniform_real_distribution<float> along(-2.5F, 2.5F);
    while (scene.positions.size() < std::size_t{3} * 700) {
        const std::array<float, 3> at{along(random), along(random), along(random)};
        if (at[0] * at[0] + at[1] * at[1] + at[2] * at[2] > 1.0F) {
            scene.positions.insert(scene.positions.end(), at.begin(), at.end());
        }
    }
    std::fill_n(scene.fluid.scatter_colour, 3, 0.0F);
    std::fill_n(scene.sky.sun_radiance, 3, 0.0F);
    scene.environment_width = 8;
    scene.environment_height = 4;
    for (std::uint32_t row = 0; row < 4; ++row) {
        for (std::uint32_t column = 0; column < 8; ++column) {
            // Red tells columns, green rows, blue both; bright, since water reflects a fiftieth.
            const float red = 3.0F + 3.0F * static_cast<float>(column);
            const float green = 4.0F + 6.0F * static_cast<float>(row);
            const float blue = (row + column) % 2 == 0 ? 20.0F : 5.0F;
            scene.environment.insert(scene.environment.end(), {red, green, blue});
        }
    }
    return scene;
}

TEST(Shade, TheMapIsReadTheRightWayRoundAcrossItsSeamAndAtItsPoles) {
    const std::array<double, 3> grey{decoded(128 / 255.0), decoded(128 / 255.0), decoded(128 / 255.0)};
    std::size_t compared = 0;
    std::size_t at_seam = 0;
    std::size_t behind = 0;
    std::size_t at_poles = 0;
    for (const std::array<double, 3> look :
         {std::array{0.0, 0.0, -1.0}, {1.0, 0.1, 0.0}, {0.1, 0.0, 1.0}, {0.1, 1.0, 0.2}, {0.1, -1.0, 0.1}}) {
        const RigScene scene = mirrorBalls(look);
        const RigResult result = rendered(scene);
        const ReferenceFrame frame(scene);
        const double ior = double{scene.fluid.index_of_refraction};
        const double f0 = std::pow((ior - 1) / (ior + 1), 2);
        for (std::size_t i = 0; i < result.depth.size(); ++i) {
            if (result.colour[i][3] == 0.0F) {
                continue;
            }
            const Vec3 ray =
                frame.ray(static_cast<double>(i % scene.width) + 0.5, static_cast<double>(i / scene.width) + 0.5);
            const double length = std::sqrt(ray[0] * ray[0] + ray[1] * ray[1] + 1);
            const Vec3 v{-ray[0] / length, -ray[1] / length, 1 / length};
            const auto mirrored = [&](const Vec3& n, double& nv) {
                nv = n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
                Vec3 world{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    for (std::size_t k = 0; k < 3; ++k) {
                        world[axis] += double{scene.camera.view[axis * 4 + k]} * (2 * nv * n[k] - v[k]);
                    }
                }
                return world;
            };
            // The normal is stored in half floats: what it may have been before spans what the colour may be.
            Vec3 low{1, 1, 1};
            Vec3 high{};
            for (std::size_t shift = 0; shift < 7; ++shift) {
                Vec3 n{double{result.normal[i][0]}, double{result.normal[i][1]}, double{result.normal[i][2]}};
                if (shift < 6) {
                    n[shift / 2] += shift % 2 == 0 ? 1e-3 : -1e-3;
                }
                const double n_length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
                n = {n[0] / n_length, n[1] / n_length, n[2] / n_length};
                double nv = 0;
                const Vec3 light = mapAt(scene, mirrored(n, nv));
                const double fresnel = f0 + (1 - f0) * std::pow(1 - std::clamp(nv, 0.0, 1.0), 5);
                for (std::size_t k = 0; k < 3; ++k) {
                    const double through =
                        grey[k] * std::exp(-double{scene.fluid.absorption[k]} * double{result.thickness_out[i]});
                    const double value = encoded(fresnel * light[k] + (1 - fresnel) * through);
                    low[k] = std::min(low[k], value);
                    high[k] = std::max(high[k], value);
                }
            }
            for (std::size_t k = 0; k < 3; ++k) {
                ASSERT_GE(double{result.colour[i][k]}, low[k] - 3e-3) << "channel " << k << " of texel " << i;
                ASSERT_LE(double{result.colour[i][k]}, high[k] + 3e-3) << "channel " << k << " of texel " << i;
            }
            double nv = 0;
            const Vec3 world =
                mirrored({double{result.normal[i][0]}, double{result.normal[i][1]}, double{result.normal[i][2]}}, nv);
            const double column = std::atan2(world[0], -world[2]) / (2 * std::numbers::pi) * 8;
            at_seam += column > -1 && column < 0 ? 1U : 0U;
            behind += std::abs(column) > 3.5 ? 1U : 0U;
            at_poles += std::abs(world[1]) > std::cos(std::numbers::pi / 8) ? 1U : 0U;
            compared += high[1] < 0.999 ? 1U : 0U;
        }
    }
    EXPECT_GT(compared, 2000U) << "unsaturated texels";
    EXPECT_GT(at_seam, 200U) << "between the last column and the first";
    EXPECT_GT(behind, 200U) << "where the longitude jumps from pi to -pi";
    EXPECT_GT(at_poles, 200U) << "beyond the middle of the outer rows";
}

TEST(Echo, GivesTheHostsImagesBack) {
    for (const SluiceDepthEncoding encoding : {SLUICE_DEPTH_WINDOW, SLUICE_DEPTH_LINEAR}) {
        RigScene scene = emptyScene();
        scene.encoding = encoding;
        scene.fluid.view = SLUICE_VIEW_ECHO;
        for (std::uint32_t i = 0; i < scene.width * scene.height; ++i) {
            scene.host_depth.push_back(static_cast<float>(i) / static_cast<float>(scene.width * scene.height));
            for (std::uint32_t k = 0; k < 4; ++k) {
                scene.host_colour.push_back(static_cast<std::uint8_t>(i * 7 + k * 31));
            }
        }
        const RigResult result = rendered(scene);
        EXPECT_EQ(result.depth, scene.host_depth);
        for (std::size_t i = 0; i < scene.host_colour.size(); ++i) {
            ASSERT_EQ(std::lround(result.colour[i / 4][i % 4] * 255.0F), scene.host_colour[i]) << i;
        }
    }
}

TEST(Views, EveryDebugViewCoversTheFluid) {
    for (const SluiceView view : {SLUICE_VIEW_DEPTH, SLUICE_VIEW_NORMAL, SLUICE_VIEW_THICKNESS}) {
        RigScene scene = cloud(300, 0.15F);
        scene.fluid.view = static_cast<std::uint32_t>(view);
        const RigResult result = rendered(scene);
        for (std::size_t i = 0; i < result.depth.size(); ++i) {
            ASSERT_EQ(result.colour[i][3], result.surface[i] < 1e29F ? 1.0F : 0.0F) << view << " at " << i;
        }
    }
}

}  // namespace
}  // namespace sluice::vk::test
