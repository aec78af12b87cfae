// SPDX-License-Identifier: MIT
// The kernels that the density constraint may have; mirrors shaders/simulation/density.glsl. Pure: no Vulkan type.
#pragma once

#include <cstdint>

namespace sluice::vk {

/// What density is measured with. Poly6 is flat at its centre and takes its gradient from spiky (Mueller et al. 2003);
/// the others have their own. docs/results/simulation.md compares them.
enum class DensityKernel : std::uint8_t { Poly6, Spline, Wendland };

/// A kernel that is not poly6, for a lattice of spacing h/2 that has the density of rest, exactly 1.
struct DensityTerms {
    double centre = 0.0;   ///< what a particle adds to the density where it is
    double tensile = 0.0;  ///< kernel at 0.2 h over that at the centre
    /// What density and slope of a half-space are multiplied with: with them, particles of a lattice whose first layer
    /// is h/4 away from a wall have density 1 there too, and are pushed nowhere.
    double wall = 0.0, wall_slope = 0.0;
};
[[nodiscard]] DensityTerms densityTerms(DensityKernel kernel);

}  // namespace sluice::vk
