// SPDX-License-Identifier: MIT
// Entries of the table of functions; api.cpp has the others.
#pragma once

#include <cstdint>

#include "sluice/plugin.h"

namespace sluice::vk {

[[nodiscard]] SluiceResult setSimulation(SluiceRenderer* renderer, const SluiceSimulation* simulation,
                                         SluiceError* error);
[[nodiscard]] SluiceResult simulate(SluiceRenderer* renderer, std::uint64_t value, double seconds, SluiceError* error);
[[nodiscard]] SluiceResult simulationWait(SluiceRenderer* renderer, std::uint64_t value, std::uint64_t timeout_ns);
[[nodiscard]] SluiceResult simulationStats(SluiceRenderer* renderer, SluiceSimulationStats* stats);
[[nodiscard]] SluiceResult simulationBodies(SluiceRenderer* renderer, std::uint64_t value, SluiceBodies* bodies);
[[nodiscard]] SluiceResult setBody(SluiceRenderer* renderer, std::uint32_t body, const SluiceBodyTarget* target,
                                   SluiceError* error);
[[nodiscard]] SluiceResult setFlow(SluiceRenderer* renderer, const SluiceFlow* flow, SluiceError* error);
[[nodiscard]] SluiceResult resetSimulation(SluiceRenderer* renderer, const SluiceStart* start, SluiceError* error);

}  // namespace sluice::vk
