// SPDX-License-Identifier: MIT
// How long a step may be for the depth of the fluid. The corrections of a step overshoot when its iterations are too
// few for the weight above: the column then gains energy until it bursts. docs/simulation.md has the measurements.
// Pure.
#pragma once

#include <cstdint>

#include "simulation/parameters.hpp"
#include "simulation/settings.hpp"

namespace sluice::vk {

/// m/s^2, whichever way it points.
[[nodiscard]] double gravityOf(const SimulationSettings& settings);
/// Whether steps are held to the depth at all: without gravity there is none.
[[nodiscard]] bool heldToDepth(const SimulationSettings& settings);
/// The axis (0 to 2) that gravity follows most.
[[nodiscard]] std::uint32_t deepestAxis(const SimulationSettings& settings);
/// Metres of fluid in a column of cells that holds so many particles, as if they were at rest.
[[nodiscard]] double depthOf(const SimulationSettings& settings, const Grid& grid, std::uint32_t particles);
/// Seconds; infinite at depth 0.
[[nodiscard]] double longestAtDepth(const SimulationSettings& settings, double depth);

}  // namespace sluice::vk
