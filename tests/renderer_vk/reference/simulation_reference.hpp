// SPDX-License-Identifier: MIT
// One step of the solver in double precision, from the formulas of docs/simulation.md: every pair is tried, nothing is
// sorted, no code is shared with the passes or with parameters.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "simulation/settings.hpp"

namespace sluice::vk::test {

using Vec = std::array<double, 3>;

struct ReferenceState {
    std::vector<Vec> position, velocity;
    std::vector<double> density;         ///< after the step
    std::vector<std::uint32_t> fluid{};  ///< of the settings'; may be empty: all of the first
};

/// A body where it is at the end of the step, and the sums of what it moves particles by.
struct ReferenceBody {
    Solid solid;
    Vec centre{}, velocity{}, spin{};
    Vec shift{}, moment{};  ///< m, and about the centre, m^2
};

[[nodiscard]] ReferenceState referenceStep(const SimulationSettings& settings, const ReferenceState& before, double dt,
                                           std::vector<ReferenceBody>& bodies);
[[nodiscard]] ReferenceState referenceStep(const SimulationSettings& settings, const ReferenceState& before, double dt);

}  // namespace sluice::vk::test
