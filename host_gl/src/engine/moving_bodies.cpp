// SPDX-License-Identifier: MIT
#include "engine/moving_bodies.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/mesh.hpp"

namespace sluice::host {

void applyPose(const MovingBody& body) {
    const auto [x, y, z, w] = body.turn;
    const std::array<float, 16> pose{1.0F - 2.0F * (y * y + z * z),
                                     2.0F * (x * y + w * z),
                                     2.0F * (x * z - w * y),
                                     0.0F,
                                     2.0F * (x * y - w * z),
                                     1.0F - 2.0F * (x * x + z * z),
                                     2.0F * (y * z + w * x),
                                     0.0F,
                                     2.0F * (x * z + w * y),
                                     2.0F * (y * z - w * x),
                                     1.0F - 2.0F * (x * x + y * y),
                                     0.0F,
                                     body.centre[0],
                                     body.centre[1],
                                     body.centre[2],
                                     1.0F};
    glMultMatrixf(pose.data());
}

void emitRound(const Vec3& half) {
    constexpr int kRings = 10;  // of each cap
    constexpr int kSegments = 32;
    constexpr float kPole = 0.002F;  // radii: a lathe's profile has no point on its axis
    const float radius = half[0];
    const float middle = half[1] - radius;
    std::vector<LathePoint> profile;
    for (const float side : {-1.0F, 1.0F}) {
        for (int ring = 0; ring <= kRings; ++ring) {
            const int step = side < 0.0F ? kRings - ring : ring;
            if (side > 0.0F && ring == 0 && middle <= 0.0F) {
                continue;  // a ball has one equator
            }
            const float angle = std::numbers::pi_v<float> / 2.0F * static_cast<float>(step) / kRings;
            const float y = side * (middle + radius * std::sin(angle));
            profile.push_back({radius * std::max(std::cos(angle), kPole), y, 0.85F + 0.15F * y / half[1]});
        }
    }
    emitLathe(0.0F, 0.0F, profile, kSegments, 2.0F, 0.5F / radius);
}

}  // namespace sluice::host
