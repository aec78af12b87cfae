// SPDX-License-Identifier: MIT
// A live simulation as the engine meets it: a value that it waits for, and where the bodies are then.
#pragma once

#include <cstdint>
#include <vector>

#include "app/live_fluid.hpp"
#include "sluice/host_gl/engine.hpp"
#include "sluice/host_gl/fluid_host.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::cli {

/// `states`: as many as the fluid has bodies, at least.
[[nodiscard]] std::vector<host::MovingBody> drawnBodies(const LiveFluid& fluid, const SluiceBodies& states);
/// Before anything has moved.
[[nodiscard]] std::vector<host::MovingBody> bodiesAtStart(const LiveFluid& fluid);

/// Until the simulation has reached `value`; fails once `patience_ns` have passed without any value, or when
/// interrupted().
[[nodiscard]] Status awaitValue(host::FluidHost& fluid, std::uint64_t value, std::uint64_t patience_ns);

}  // namespace sluice::cli
