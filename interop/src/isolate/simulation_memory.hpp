// SPDX-License-Identifier: MIT
// The arrays of a simulation in the memory that came with it.
#pragma once

#include "sluice/isolate/sealed_memory.hpp"
#include "sluice/plugin.h"

namespace sluice::isolate {

/// Maps `fd` and sets every array of `simulation` to its place in it, in the order of eachArray.
[[nodiscard]] Result<Mapping> placeArrays(SluiceSimulation& simulation, bool velocities, const UniqueFd& fd);

}  // namespace sluice::isolate
