// SPDX-License-Identifier: MIT
// The uniform block of every pass of the solver: mirrors shaders/simulation/simulation.glsl. Pure: no Vulkan type.
#pragma once

#include <array>
#include <cstdint>

#include "simulation/settings.hpp"

namespace sluice::vk {

struct SolidBlock {
    std::array<float, 4> a, b, q;
};
struct Parameters {
    std::array<float, 4> gravity, low, high, kernel, fluid, search;
    std::array<std::uint32_t, 4> count, grid, change;
    std::array<SolidBlock, kMaxSolids> solids;
};
static_assert(sizeof(Parameters) == 144 + 48 * kMaxSolids, "std140");

/// The cells of the neighbour search. x is one row of cells with an empty one at each end; y and z are powers of two
/// and wrap around when the domain has more.
struct Grid {
    std::uint32_t x = 0, y = 0, z = 0;
    double side = 0.0;  ///< of a cell, metres: the support and what rounding may take from it
    [[nodiscard]] std::uint32_t cells() const { return x * y * z; }
};
/// Not many more cells than particles, and at most kMostCells. The settings have been checked.
inline constexpr std::uint32_t kMostCells = 1U << 22;
[[nodiscard]] Grid planGrid(const SimulationSettings& settings, std::uint32_t particles);

/// Volume of a particle, m^3: with it, a cubic lattice of spacing 2r has the density of rest, exactly 1.
[[nodiscard]] double particleVolume(double radius);

/// What the density of a wall, poly6 integrated over a half-space, is multiplied with: with it, a cubic lattice whose
/// first layer is a radius away from the wall has the density of rest there too, exactly 1. A number near 0.881.
[[nodiscard]] double wallFactor();

/// How many particles a step has, and what becomes of them.
struct StepCounts {
    std::uint32_t entries = 0;  ///< before the sort; some may be gone
    std::uint32_t living = 0;   ///< those that are not
    std::uint32_t births = 0;   ///< after it
    std::uint32_t next_identity = 0;
};

/// `stride` is the distance between rows of the neighbour lists, `most` the rows.
[[nodiscard]] Parameters parametersOf(const SimulationSettings& settings, const Grid& grid, const StepCounts& counts,
                                      std::uint32_t stride, std::uint32_t most, float dt);

}  // namespace sluice::vk
