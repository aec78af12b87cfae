// SPDX-License-Identifier: MIT
// Small scenes for the tests of the passes, and the rig that they share.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "pass_rig.hpp"

namespace sluice::vk::test {

/// One rig per program: the device is the slow part.
inline PassRig& rig() {
    static PassRig shared;
    return shared;
}

/// Renders, and fails the test on an error or on any message of the validation layer.
inline RigResult rendered(const RigScene& scene) {
    RigResult result = rig().render(scene);
    EXPECT_EQ(result.failure, "");
    EXPECT_EQ(rig().validationMessages(), 0U);
    return result;
}

/// An odd size, an off-centre projection, the camera at the origin looking down -z.
inline RigScene emptyScene() {
    RigScene scene;
    scene.width = 67;
    scene.height = 43;
    scene.camera = perspective(1.0, 67.0 / 43.0, 0.1F, 20.0F, {0.13, -0.21});
    scene.sky = clearDay();
    scene.radius = 0.1F;
    return scene;
}

inline RigScene withoutFilter(RigScene scene) {
    scene.fluid.filter = SLUICE_FILTER_NONE;
    return scene;
}

/// Spheres everywhere: in front, off screen, behind, across the near plane, beyond the far plane.
inline RigScene cloud(std::uint32_t count, float radius, std::uint32_t seed = 7) {
    RigScene scene = emptyScene();
    scene.radius = radius;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> x(-2.5F, 2.5F);
    std::uniform_real_distribution<float> z(-6.0F, 0.4F);
    for (std::uint32_t i = 0; i < count; ++i) {
        scene.positions.insert(scene.positions.end(), {x(random), x(random), z(random)});
    }
    return scene;
}

/// A lattice of spacing 2r, `layers` deep, whose front face looks at the camera.
inline RigScene slab(int columns, int layers, float radius, float front) {
    RigScene scene = emptyScene();
    scene.camera = perspective(1.0, 67.0 / 43.0, 0.1F, 20.0F);
    scene.radius = radius;
    for (int k = 0; k < layers; ++k) {
        for (int j = -columns; j <= columns; ++j) {
            for (int i = -columns; i <= columns; ++i) {
                const auto at = [&](int n) { return static_cast<float>(n) * 2.0F * radius; };
                scene.positions.insert(scene.positions.end(), {at(i), at(j), -front - radius - at(k)});
            }
        }
    }
    return scene;
}

}  // namespace sluice::vk::test
