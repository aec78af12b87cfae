// SPDX-License-Identifier: MIT
#include "plugin/simulation_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "plugin/simulation_arrays.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/simulation_arrays.hpp"

namespace sluice::vk {
namespace {

/// What the solver's dispatches reach.
constexpr std::uint32_t kMostWithEmitters = 4'000'000;
/// Of a driven body, m: a solver's domain is smaller.
constexpr double kFarthest = 1e8;

Error invalid(const char* thing, std::string detail, const char* remedy = "") {
    return {SLUICE_ERROR_INVALID_ARGUMENT, thing, std::move(detail), remedy};
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
                           fmt::format("number {} has kind {}, which is no SluiceSolidKind", index, solid.kind),
                           "give one from SLUICE_SOLID_PLANE to SLUICE_SOLID_BOX, and 0 in what is not used");
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
    if (Status status = checkArrays(s); !status) {
        return status;
    }
    const std::uint32_t least = std::max(s.particle_count, s.emitter_count > 0 ? 1U : 0U);
    const std::uint32_t most = s.emitter_count > 0 ? kMostWithEmitters : kMostSimulatedParticles;
    if (s.max_particles > most || (s.max_particles < least && (s.emitter_count > 0 || s.max_particles != 0))) {
        return invalid("simulation.max_particles", fmt::format("{} is outside {}..{}", s.max_particles, least, most));
    }
    return {};
}

Status readKernel(std::uint32_t kernel, DensityKernel& to) {
    switch (kernel) {
        case SLUICE_KERNEL_DEFAULT:
        case SLUICE_KERNEL_POLY6:
            to = DensityKernel::Poly6;
            return {};
        case SLUICE_KERNEL_SPLINE:
            to = DensityKernel::Spline;
            return {};
        case SLUICE_KERNEL_WENDLAND:
            to = DensityKernel::Wendland;
            return {};
        default:
            return invalid("simulation.density_kernel", fmt::format("{} is no SluiceDensityKernel", kernel));
    }
}

/// The host's depth as a solid; nothing is seen to begin with.
Status readDepth(const SluiceSimulation& s, LiveSetup& to) {
    if (s.depth_scale == 0) {
        return {};
    }
    if (s.depth_scale > 8) {
        return invalid("simulation.depth_scale", fmt::format("{} is outside 0..8", s.depth_scale));
    }
    if (s.depth_lag > s.frames_in_flight) {
        return invalid("simulation.depth_lag",
                       fmt::format("{} is outside 0..{} (frames_in_flight)", s.depth_lag, s.frames_in_flight));
    }
    const float thickness = s.depth_thickness != 0.0F ? s.depth_thickness : kThicknessInRadii * s.radius;
    if (!(thickness >= s.radius && thickness <= 1e6F)) {
        return invalid("simulation.depth_thickness",
                       fmt::format("{} m is outside [{} (a radius), 1e6]", thickness, s.radius));
    }
    to.settings.seen = std::make_shared<const DepthField>();
    to.depth_scale = s.depth_scale;
    to.depth_lag = s.depth_lag != 0 ? s.depth_lag : s.frames_in_flight;
    to.depth_thickness = thickness;
    return {};
}

Status readFoam(const SluiceSimulation& s, LiveSetup& to) {
    if (s.foam_life == 0.0F) {
        return {};
    }
    if (!(s.foam_life > 0.0F && s.foam_life <= 1e6F)) {
        return invalid("simulation.foam_life", fmt::format("{} s is outside [0, 1e6]", s.foam_life));
    }
    FoamSettings foam;
    foam.life = double{s.foam_life};
    const auto take = [](const float(&given)[2], WhitewaterRange& range) {
        if (given[0] != 0.0F || given[1] != 0.0F) {
            range = {given[0], given[1]};
        }
    };
    take(s.foam_air, foam.ranges.air);
    take(s.foam_crest, foam.ranges.crest);
    take(s.foam_energy, foam.ranges.energy);
    to.foam = foam;
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
    to.tension = s.tension;
    to.adhesion = s.adhesion;
    if (s.overshoot != 0.0F) {
        to.overshoot = s.overshoot < 0.0F ? 0.0F : s.overshoot;
    }
    to.fluids = readFluids(s.fluids, s.fluid_count);
    if (Status status = readKernel(s.density_kernel, to.kernel); !status) {
        return status.error();
    }
    if (Status status = readSources(s, to.sources); !status) {
        return status.error();
    }
    Result<std::vector<Body>> bodies = readBodies(s);
    if (!bodies) {
        return bodies.error();
    }
    to.bodies = std::move(bodies).value();
    if (Status status = s.mesh_count > 0 ? readMeshes(s, to) : Status{}; !status) {
        return status.error();
    }
    if (s.anisotropy != 0.0F) {
        const Anisotropy usual;
        setup.anisotropy = Anisotropy{s.anisotropy, s.smoothing, s.lonely != 0.0F ? s.lonely : usual.lonely};
    }
    if (Status status = readDepth(s, setup); !status) {
        return status.error();
    }
    if (Status status = readFoam(s, setup); !status) {
        return status.error();
    }
    setup.most_particles = s.emitter_count > 0 ? s.max_particles : std::max(s.max_particles, s.particle_count);
    const std::size_t floats = std::size_t{3} * s.particle_count;
    setup.position.assign(s.position, s.position + floats);
    if (s.velocity != nullptr) {
        setup.velocity.assign(s.velocity, s.velocity + floats);
    }
    setup.fluid.assign(s.particle_fluids, s.particle_fluids + s.particle_fluid_count);
    return setup;
}

Result<BodyTarget> readTarget(std::uint32_t body, const SluiceBodyTarget* target) {
    if (Status status = checkAbiStruct(target, "target"); !status) {
        return status.error();
    }
    const SluiceBodyTarget given = readAbiStruct(*target);
    BodyTarget to{body, wide(triple(given.centre)), {}};
    double square = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        to.turn.at(i) = double{given.turn[i]};
        square += to.turn.at(i) * to.turn.at(i);
    }
    const Vector& x = to.centre;
    if (!(std::abs(x[0]) + std::abs(x[1]) + std::abs(x[2]) < kFarthest) || !(square > 1e-12 && square < 1e12)) {
        return invalid("target", fmt::format("expected a centre within {} m and a turn of a length above 0, found "
                                             "[{}, {}, {}] and one of {}",
                                             kFarthest, x[0], x[1], x[2], std::sqrt(square)));
    }
    return to;
}

Result<FlowSettings> readFlow(const SluiceFlow* flow) {
    if (Status status = checkAbiStruct(flow, "flow"); !status) {
        return status.error();
    }
    const SluiceFlow given = readAbiStruct(*flow);
    if (given.emitter_count > SLUICE_MAX_EMITTERS) {
        return invalid("flow.emitters",
                       fmt::format("expected at most {}, found {}", SLUICE_MAX_EMITTERS, given.emitter_count));
    }
    if (given.fluid_count > SLUICE_MAX_FLUIDS) {
        return invalid("flow.fluids",
                       fmt::format("expected at most {}, found {}", SLUICE_MAX_FLUIDS, given.fluid_count));
    }
    auto emitters = sized<SluiceSimulation>();
    emitters.emitter_count = given.emitter_count;
    emitters.emitters = &given.emitters[0];
    SourceSettings sources;
    if (Status status = readSources(emitters, sources); !status) {
        return status.error();
    }
    return FlowSettings{given.iterations,
                        triple(given.gravity),
                        given.viscosity,
                        given.vorticity,
                        given.tension,
                        given.adhesion,
                        std::move(sources.emitters),
                        readFluids(&given.fluids[0], given.fluid_count)};
}

Result<LiveStart> readStart(const SluiceStart* start) {
    if (Status status = checkAbiStruct(start, "start"); !status) {
        return status.error();
    }
    const SluiceStart given = readAbiStruct(*start);
    if (Status status = checkArrays(given); !status) {
        return status.error();
    }
    const std::size_t floats = std::size_t{3} * given.particle_count;
    LiveStart to;
    to.position.assign(given.position, given.position + floats);
    if (given.velocity != nullptr) {
        to.velocity.assign(given.velocity, given.velocity + floats);
    }
    if (given.particle_fluids != nullptr) {
        to.fluid.assign(given.particle_fluids, given.particle_fluids + given.particle_count);
    }
    return to;
}

}  // namespace sluice::vk
