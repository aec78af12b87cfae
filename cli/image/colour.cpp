// SPDX-License-Identifier: MIT
#include "image/colour.hpp"

#include <cmath>
#include <limits>

namespace sluice::cli {

float srgbToLinear(float encoded) {
    return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

float linearDepth(float window_depth, float near_plane, float far_plane) {
    if (window_depth >= 1.0F) {
        return std::numeric_limits<float>::infinity();
    }
    // In double: far - d (far - near) cancels where depth is nearly 1, which is most of a scene.
    const double near = near_plane;
    const double far = far_plane;
    return static_cast<float>(near * far / (far - static_cast<double>(window_depth) * (far - near)));
}

}  // namespace sluice::cli
