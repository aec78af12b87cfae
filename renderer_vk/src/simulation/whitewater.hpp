// SPDX-License-Identifier: MIT
// What is asked of a particle before it makes spray, foam and bubbles; shaders/simulation/whitewater.comp has the pass.
#pragma once

#include <cstddef>

#include "sluice/result.hpp"

namespace sluice::vk {

/// Floats of a particle: trapped air, wave crest, kinetic energy, and what turns white of all: energy times the sum of
/// the other two. Each 0 to 1.
inline constexpr std::size_t kWhitewaterFloats = 4;

/// From where a value counts, and from where it is 1. The defaults are what SPlisHSPlasH's foam generator takes.
struct WhitewaterRange {
    float low = 0.0F, high = 1.0F;
};
struct Whitewater {
    WhitewaterRange air{5.0F, 20.0F};     ///< m/s, summed over neighbours
    WhitewaterRange crest{2.0F, 8.0F};    ///< curvature, summed over neighbours
    WhitewaterRange energy{5.0F, 50.0F};  ///< m^2/s^2: half the square of the speed
};
[[nodiscard]] Status checkWhitewater(const Whitewater& how);

}  // namespace sluice::vk
