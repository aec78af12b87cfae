// SPDX-License-Identifier: MIT
// Several fluids in one simulation. Pure: no Vulkan type.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sluice/result.hpp"

namespace sluice::vk {

struct SimulationSettings;

/// What the particles of one fluid are made of. All particles have the same volume at rest.
struct Fluid {
    float density = 1.0F;     ///< at rest, of water at rest
    float viscosity = 0.02F;  ///< c of XSPH, 0 to 1; between two fluids their mean
    float tension = 0.0F;     ///< gamma of Akinci et al. 2013, m/s^2; between two fluids their geometric mean
    float adhesion = 0.0F;    ///< beta of the same, towards walls
};

inline constexpr std::size_t kMaxFluids = 8;
/// Greatest density over the least: what docs/simulation.md has measured as stable.
inline constexpr double kMostDensityRatio = 16.0;

/// Of the heaviest over the lightest; 1 for one.
[[nodiscard]] double densityRatio(std::span<const Fluid> fluids);
/// The first that is out of its range, named.
[[nodiscard]] Status checkFluids(std::span<const Fluid> fluids);
/// Those of the settings, and that every emitter names one of them.
[[nodiscard]] Status checkFluids(const SimulationSettings& settings);
/// `fluids`: empty, or one number below the fluids' for each of `particles`.
[[nodiscard]] Status checkFluidNumbers(const SimulationSettings& settings, std::span<const std::uint32_t> fluids,
                                       std::size_t particles);
/// Fluids that flow may change in all but their number and their densities: mass is not made.
[[nodiscard]] Status checkChange(std::span<const Fluid> before, std::span<const Fluid> after);
/// A single fluid of density 1 as settings without a list of fluids, which need nothing beyond the plain passes.
[[nodiscard]] SimulationSettings withoutNeedlessFluids(const SimulationSettings& settings);

/// Mirrors Fluid of shaders/simulation/simulation.glsl.
struct FluidBlock {
    std::array<float, 4> a;  ///< density, 1 / density, XSPH, tension
    std::array<float, 4> b;  ///< adhesion
};
[[nodiscard]] FluidBlock fluidBlock(const Fluid& fluid);

}  // namespace sluice::vk
