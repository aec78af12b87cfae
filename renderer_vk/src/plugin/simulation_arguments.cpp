// SPDX-License-Identifier: MIT
#include "plugin/simulation_arguments.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "sluice/abi_sizes.hpp"
#include "sluice/simulation_limits.hpp"

namespace sluice::vk {
namespace {

Error invalid(const char* thing, std::string detail) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, thing, std::move(detail), ""};
}

Triple triple(const float (&values)[3]) {
    return {values[0], values[1], values[2]};
}

Result<Solid> solidOf(const SluiceSolid& solid, std::size_t index) {
    const float all[] = {solid.a[0], solid.a[1], solid.a[2],   solid.b[0],
                         solid.b[1], solid.b[2], solid.radius, solid.turn_degrees};
    for (const float value : all) {
        if (!std::isfinite(value)) {
            return invalid("simulation.solids", fmt::format("number {} has {}, which is not finite", index, value));
        }
    }
    switch (solid.kind) {
        case SLUICE_SOLID_PLANE:
            return planeSolid(triple(solid.a), triple(solid.b));
        case SLUICE_SOLID_SPHERE:
            return sphereSolid(triple(solid.a), solid.radius);
        case SLUICE_SOLID_CAPSULE:
            return capsuleSolid(triple(solid.a), triple(solid.b), solid.radius);
        case SLUICE_SOLID_BOX:
            return boxSolid(triple(solid.a), triple(solid.b), solid.turn_degrees);
        default:
            return invalid("simulation.solids",
                           fmt::format("number {} has kind {}, which is no SluiceSolidKind", index, solid.kind));
    }
}

Status checkCounts(const SluiceSimulation& s) {
    if (s.frames_in_flight < 1 || s.frames_in_flight > SLUICE_MAX_FRAMES_IN_FLIGHT) {
        return invalid("simulation.frames_in_flight",
                       fmt::format("{} is outside 1..{}", s.frames_in_flight, SLUICE_MAX_FRAMES_IN_FLIGHT));
    }
    if (!(s.longest_step > 0.0 && s.longest_step <= 1.0)) {
        return invalid("simulation.longest_step", fmt::format("{} s is outside (0, 1]", s.longest_step));
    }
    if (s.particle_count == 0 || s.particle_count > kMostSimulatedParticles || s.position == nullptr) {
        return invalid("simulation.position",
                       fmt::format("expected 1 to {} particles, found {}{}", kMostSimulatedParticles, s.particle_count,
                                   s.position == nullptr ? " at NULL" : ""));
    }
    if (s.solid_count > kMostSolids || (s.solid_count > 0 && s.solids == nullptr)) {
        return invalid("simulation.solids", fmt::format("expected at most {}, found {}{}", kMostSolids, s.solid_count,
                                                        s.solids == nullptr ? " at NULL" : ""));
    }
    return {};
}

}  // namespace

Result<LiveSetup> readSimulation(const SluiceSimulation* simulation) {
    if (Status status = checkAbiStruct(simulation, "simulation"); !status) {
        return status.error();
    }
    const SluiceSimulation s = readAbiStruct(*simulation);
    if (Status status = checkCounts(s); !status) {
        return status.error();
    }
    LiveSetup setup;
    setup.frames_in_flight = s.frames_in_flight;
    setup.longest_step = s.longest_step;
    SimulationSettings& to = setup.settings;
    to.radius = s.radius;
    to.low = triple(s.low);
    to.high = triple(s.high);
    to.gravity = triple(s.gravity);
    to.iterations = s.iterations;
    to.relaxation = s.relaxation;
    to.tensile = s.tensile;
    to.viscosity = s.viscosity;
    to.vorticity = s.vorticity;
    to.cfl = s.cfl;
    for (std::size_t i = 0; i < s.solid_count; ++i) {
        const Result<Solid> solid = solidOf(s.solids[i], i);
        if (!solid) {
            return solid.error();
        }
        to.solids.push_back(solid.value());
    }
    const std::size_t floats = std::size_t{3} * s.particle_count;
    setup.position.assign(s.position, s.position + floats);
    if (s.velocity != nullptr) {
        setup.velocity.assign(s.velocity, s.velocity + floats);
    }
    return setup;
}

}  // namespace sluice::vk
