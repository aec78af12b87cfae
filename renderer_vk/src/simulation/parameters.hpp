// SPDX-License-Identifier: MIT
// The uniform block of every pass of the solver: mirrors shaders/simulation/simulation.glsl. Pure: no Vulkan type.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "simulation/settings.hpp"

namespace sluice::vk {

struct SolidBlock {
    std::array<float, 4> a, b, q;
};
struct Parameters {
    std::array<float, 4> gravity, low, high, kernel, fluid, search, constraint;
    std::array<std::uint32_t, 4> count, grid, change;
    std::array<float, 4> surface;
    std::array<float, 20> adhesion;
    std::array<SolidBlock, kMaxSolids + kMaxBodies> solids;  ///< bodies behind those that stand still
    std::array<FluidBlock, kMaxFluids> fluids;
};
static_assert(sizeof(Parameters) == 256 + 48 * (kMaxSolids + kMaxBodies) + 32 * kMaxFluids, "std140");

/// The cells of the neighbour search. x is one row of cells with an empty one at each end; y and z are powers of two
/// and wrap around when the domain has more.
struct Grid {
    std::uint32_t x = 0, y = 0, z = 0;
    double side = 0.0;  ///< of a cell, metres: the support and what rounding may take from it
    [[nodiscard]] std::uint32_t cells() const { return x * y * z; }
    /// Along that axis.
    [[nodiscard]] std::uint32_t columns(std::uint32_t axis) const {
        return axis == 0 ? y * z : axis == 1 ? x * z : x * y;
    }
};
/// Not many more cells than particles, and at most kMostCells. The settings have been checked.
inline constexpr std::uint32_t kMostCells = 1U << 22;
[[nodiscard]] Grid planGrid(const SimulationSettings& settings, std::uint32_t particles);

/// Volume of a particle, m^3: with it, a cubic lattice of spacing 2r has the density of rest, exactly 1.
[[nodiscard]] double particleVolume(double radius);

/// What the density of a wall, poly6 integrated over a half-space, is multiplied with: with it, a cubic lattice whose
/// first layer is a radius away from the wall has the density of rest there too, exactly 1. A number near 0.881.
[[nodiscard]] double wallFactor();

/// Adhesion of a half-space `q` supports away, of strength 1 and density 1: Akinci et al. 2013's kernel (eq. 7)
/// integrated over it, along its normal.
[[nodiscard]] double halfSpaceAdhesion(double q);

/// How many particles a step has, and what becomes of them.
struct StepCounts {
    std::uint32_t entries = 0;  ///< before the sort; some may be gone
    std::uint32_t living = 0;   ///< those that are not
    std::uint32_t births = 0;   ///< after it
    std::uint32_t next_identity = 0;
};

/// Bodies as the passes see them; mirrors shaders/simulation/bodies.glsl.
struct BodyBlock {
    struct One {
        std::array<float, 4> centre, velocity, spin;
    };
    std::array<One, kMaxBodies> body;
};
/// What the fluid gives a body: shift times arm, in parts of the support that the passes count in whole numbers.
struct BodyPush {
    std::array<std::array<std::uint32_t, 2>, 6> sums;  ///< low and high parts of x, y, z and of the moment's
};
/// Linear and angular momentum, m^3 m/s and m^3 m^2/s, that the body got in a step of that length.
struct BodyImpulse {
    Vector linear{}, angular{};
};
[[nodiscard]] BodyImpulse impulseOf(const BodyPush& push, const SimulationSettings& settings, const Body& body,
                                    double seconds);
[[nodiscard]] BodyBlock bodyBlock(std::span<const Body> bodies, std::span<const BodyState> states);

/// `stride` is the distance between rows of the neighbour lists, `most` the rows.
[[nodiscard]] Parameters parametersOf(const SimulationSettings& settings, const Grid& grid, const StepCounts& counts,
                                      std::uint32_t stride, std::uint32_t most, float dt,
                                      std::span<const BodyState> bodies = {});

}  // namespace sluice::vk
