// SPDX-License-Identifier: MIT
// Shading against its formulas in double precision, and what the host may rely on.
#include <algorithm>
#include <cmath>
#include <cstring>

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

TEST(Shade, TheMapIsReadAcrossItsSeam) {
    RigScene scene = slab(8, 2, 0.1F, 2.0F);
    scene.environment_width = 4;
    scene.environment_height = 2;
    scene.environment.assign(4 * 2 * 3, 0.5F);
    std::fill_n(scene.sky.sun_radiance, 3, 0.0F);
    const RigResult map = rendered(scene);
    std::fill_n(scene.sky.zenith, 3, 0.5F);
    std::fill_n(scene.sky.horizon, 3, 0.5F);
    std::fill_n(scene.sky.ground, 3, 0.5F);
    scene.environment.clear();
    const RigResult sky = rendered(scene);
    for (std::size_t i = 0; i < map.colour.size(); ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            ASSERT_NEAR(map.colour[i][k], sky.colour[i][k], 1e-3F) << i;
        }
    }
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
