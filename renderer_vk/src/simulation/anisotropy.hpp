// SPDX-License-Identifier: MIT
// How a particle's neighbours become an ellipsoid; shaders/simulation/anisotropy.comp has the pass.
#pragma once

#include <cmath>
#include <cstddef>

#include "sluice/result.hpp"

namespace sluice::vk {

/// Largest ratio of an ellipsoid's axes. Thinner than this, and a ray's distance in floats says little.
inline constexpr float kMostStretched = 10.0F;
/// Floats of an ellipsoid: its centre, then xx, xy, xz, yy, yz, zz of its stretch.
inline constexpr std::size_t kEllipsoidFloats = 9;

struct Anisotropy {
    float ratio = 4.0F;      ///< greatest of the longest axis to the shortest, 1 to kMostStretched
    float smoothing = 0.0F;  ///< how far a centre goes to its neighbours' mean: 0 stays, which shrinks nothing
    float lonely = 0.5F;     ///< size of a particle without neighbours, (0, 1]
};
[[nodiscard]] Status checkAnisotropy(const Anisotropy& how);

/// The longest axis that an ellipsoid of that ratio can have, in splat radii: a thread, whose volume is a sphere's.
[[nodiscard]] inline float longestStretch(float ratio) {
    return std::pow(ratio, 2.0F / 3.0F);
}

}  // namespace sluice::vk
