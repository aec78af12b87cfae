// SPDX-License-Identifier: MIT
// Pictures of depths of planes and solids, for the tests of what a camera sees.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "reference/seen_reference.hpp"

namespace sluice::vk::test {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kRadius = 0.02F;

/// Looks from `eye` to `target`; a right angle from left to right.
inline DepthView looking(const Vector& eye, const Vector& target, std::uint32_t width, std::uint32_t height,
                         const Vector& upward = {0, 1, 0}) {
    const Vector back = unit(minus(eye, target));
    const Vector right = unit(cross(upward, back));
    const Vector up = cross(back, right);
    DepthView camera;
    for (std::size_t i = 0; i < 3; ++i) {
        camera.view.at(4 * i) = static_cast<float>(right.at(i));
        camera.view.at(4 * i + 1) = static_cast<float>(up.at(i));
        camera.view.at(4 * i + 2) = static_cast<float>(back.at(i));
    }
    camera.view[12] = static_cast<float>(-dot(right, eye));
    camera.view[13] = static_cast<float>(-dot(up, eye));
    camera.view[14] = static_cast<float>(-dot(back, eye));
    camera.view[15] = 1.0F;
    camera.near_plane = 0.05F;
    camera.projection[0] = 1.0F;
    camera.projection[5] = static_cast<float>(width) / static_cast<float>(height);
    camera.projection[8] = 0.06F;  // not symmetric: as a shifted lens, or half of a pair of eyes
    camera.projection[9] = -0.04F;
    camera.projection[11] = -1.0F;
    return camera;
}

/// The depth of the first of the planes and solids that each texel looks at; +infinity where there is none.
inline DepthField picture(const DepthView& camera, std::uint32_t width, std::uint32_t height,
                          const std::vector<Solid>& solids) {
    DepthField field{width,
                     height,
                     {static_cast<float>(width), static_cast<float>(height)},
                     camera,
                     kThicknessInRadii * kRadius,
                     std::vector<float>(std::size_t{width} * height, kInfinity)};
    const reference::Seer seer(field);
    for (std::size_t i = 0; i < field.depth.size(); ++i) {
        const std::size_t row = i / width;
        const Vec way = seer.way(static_cast<double>(i % width) + 0.5, static_cast<double>(row) + 0.5);
        double depth = 0.05;
        for (int step = 0; step < 4000 && depth < 6.0; ++step) {  // sphere tracing
            const Vector x = plus(seer.eye(), times(depth, way));
            double nearest = 1e9;
            for (const Solid& solid : solids) {
                nearest = std::min(nearest, contactWith(solid, x).distance);
            }
            if (nearest < 1e-7) {
                field.depth[i] = static_cast<float>(depth);
                break;
            }
            depth += nearest / length(way);
        }
    }
    return field;
}

}  // namespace sluice::vk::test
