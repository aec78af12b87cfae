// SPDX-License-Identifier: MIT
// A SluiceSimulation as the solver's settings.
#pragma once

#include "live/live_simulation.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

/// INVALID_ARGUMENT names what the solver's own checks would not see: pointers, kinds, counts. What the numbers may be
/// is the solver's to say.
[[nodiscard]] Result<LiveSetup> readSimulation(const SluiceSimulation* simulation);
[[nodiscard]] Result<BodyTarget> readTarget(std::uint32_t body, const SluiceBodyTarget* target);
[[nodiscard]] Result<FlowSettings> readFlow(const SluiceFlow* flow);
[[nodiscard]] Result<LiveStart> readStart(const SluiceStart* start);

}  // namespace sluice::vk
