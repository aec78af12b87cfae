// SPDX-License-Identifier: MIT
// What comes, goes, moves and stands in a fluid, since ABI 1.2: the arrays of a SluiceSimulation as the solver has
// them. All have passed checkArrays. Numbers are the solver's to check; here, what a word stands for.
#pragma once

#include <vector>

#include "simulation/settings.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

[[nodiscard]] inline Triple triple(const float (&values)[3]) {
    return {values[0], values[1], values[2]};
}

[[nodiscard]] std::vector<Fluid> readFluids(const SluiceFluidKind* fluids, std::size_t count);
[[nodiscard]] Status readSources(const SluiceSimulation& simulation, SourceSettings& sources);
[[nodiscard]] Result<std::vector<Body>> readBodies(const SluiceSimulation& simulation);
/// Computes the distances. `settings` is final in all but its meshes, and is checked for it.
[[nodiscard]] Status readMeshes(const SluiceSimulation& simulation, SimulationSettings& settings);

}  // namespace sluice::vk
