// SPDX-License-Identifier: MIT
// A simulation that begins with the particles of a file.
#pragma once

#include <cstdint>

#include "simulator/simulator.hpp"
#include "sluice/result.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// A file to begin with, boxes or an emitter.
[[nodiscard]] bool hasFluid(const scene::Simulation& simulation);

/// The particles of simulation.start, with their velocities if it has any, and behind them startOfFluid's. Of several
/// fluids each is the one whose colour is nearest to its own; the first, without colours. Refused by name: a file that
/// is none, another radius, more than kMostSimulated, a particle in a solid, a body or a box of fluid, or outside the
/// domain.
[[nodiscard]] Result<simulator::Particles> wholeStart(const scene::Simulation& simulation,
                                                      const simulator::Setup& setup, std::uint64_t seed);

}  // namespace sluice::cli
