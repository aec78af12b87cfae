// SPDX-License-Identifier: MIT
#include "app/live_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/interrupt.hpp"

namespace sluice::cli {

std::vector<host::MovingBody> drawnBodies(const LiveFluid& fluid, const SluiceBodies& states) {
    std::vector<host::MovingBody> bodies;
    for (std::size_t i = 0; i < std::min<std::size_t>(fluid.bodies.size(), states.count); ++i) {
        const SluiceBodyState& state = states.bodies[i];
        host::MovingBody& body = bodies.emplace_back();
        body.box = fluid.bodies[i].shape == SLUICE_SOLID_BOX;
        std::copy(std::begin(state.centre), std::end(state.centre), body.centre.begin());
        std::copy(std::begin(fluid.bodies[i].half), std::end(fluid.bodies[i].half), body.half.begin());
        std::copy(std::begin(state.turn), std::end(state.turn), body.turn.begin());
    }
    return bodies;
}

std::vector<host::MovingBody> bodiesAtStart(const LiveFluid& fluid) {
    SluiceBodies start{};
    start.count = static_cast<std::uint32_t>(std::min<std::size_t>(fluid.bodies.size(), SLUICE_MAX_BODIES));
    for (std::size_t i = 0; i < start.count; ++i) {
        const SluiceBody& body = fluid.bodies[i];
        SluiceBodyState& state = start.bodies[i];
        const bool path = body.path_count > 0;
        const float(&centre)[3] = path ? fluid.path_points[body.path_first].centre : body.centre;
        std::copy(std::begin(centre), std::end(centre), std::begin(state.centre));
        const float degrees = path ? fluid.path_points[body.path_first].turn_degrees : body.turn_degrees;
        const float half = degrees * std::numbers::pi_v<float> / 360.0F;
        state.turn[1] = std::sin(half);
        state.turn[3] = std::cos(half);
    }
    return drawnBodies(fluid, start);
}

Status awaitValue(host::FluidHost& fluid, std::uint64_t value, std::uint64_t patience_ns) {
    for (std::uint64_t before = 0;;) {
        Status status = fluid.waitForSimulation(value, patience_ns);
        if (status || status.error().code != SLUICE_TIMEOUT || interrupted()) {
            return status;
        }
        const Result<SluiceSimulationStats> stats = fluid.simulationStats();
        if (!stats || stats.value().reached <= before) {
            return status;
        }
        before = stats.value().reached;
    }
}

}  // namespace sluice::cli
