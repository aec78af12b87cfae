// SPDX-License-Identifier: MIT
// Where the bodies of a live simulation are, for the engine to draw.
#pragma once

#include <vector>

#include "app/live_fluid.hpp"
#include "sluice/host_gl/engine.hpp"
#include "sluice/plugin.h"

namespace sluice::cli {

/// `states`: as many as the fluid has bodies, at least.
[[nodiscard]] std::vector<host::MovingBody> drawnBodies(const LiveFluid& fluid, const SluiceBodies& states);
/// Before anything has moved.
[[nodiscard]] std::vector<host::MovingBody> bodiesAtStart(const LiveFluid& fluid);

}  // namespace sluice::cli
