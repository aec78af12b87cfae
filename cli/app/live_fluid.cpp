// SPDX-License-Identifier: MIT
#include "app/live_fluid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "app/simulate_setup.hpp"

namespace sluice::cli {
namespace {

SluiceSolid solid(SluiceSolidKind kind, const simulator::Vec3& a, const simulator::Vec3& b, float radius,
                  float turn_degrees = 0.0F) {
    SluiceSolid out{};
    out.kind = kind;
    std::copy(a.begin(), a.end(), &out.a[0]);
    std::copy(b.begin(), b.end(), &out.b[0]);
    out.radius = radius;
    out.turn_degrees = turn_degrees;
    return out;
}

std::vector<SluiceSolid> solidsOf(const simulator::Setup& setup) {
    std::vector<SluiceSolid> solids;
    // In the order in which `sluice simulate` hands them to the solver: the walls' densities are joined in it.
    for (const simulator::Sphere& sphere : setup.spheres) {
        solids.push_back(solid(SLUICE_SOLID_SPHERE, sphere.centre, {}, sphere.radius));
    }
    for (const simulator::Capsule& capsule : setup.capsules) {
        solids.push_back(solid(SLUICE_SOLID_CAPSULE, capsule.from, capsule.to, capsule.radius));
    }
    for (const simulator::Box& box : setup.boxes) {
        solids.push_back(solid(SLUICE_SOLID_BOX, box.centre, box.half, 0.0F, box.turn_degrees));
    }
    for (const simulator::Plane& plane : setup.planes) {
        solids.push_back(solid(SLUICE_SOLID_PLANE, plane.normal, plane.through, 0.0F));
    }
    return solids;
}

/// What `sluice simulate` knows and the C ABI does not.
Status checkCrosses(const simulator::Setup& setup, std::size_t meshes) {
    const std::array<std::pair<const char*, std::size_t>, 8> all{
        {{"emitters", setup.emitters.size()},
         {"drains", setup.drains.size()},
         {"fields", setup.fields.size()},
         {"bodies", setup.bodies.size()},
         {"meshes", meshes},
         {"tension", setup.tension != 0.0F ? 1U : 0U},
         {"adhesion", setup.adhesion != 0.0F ? 1U : 0U},
         {"overshoot", setup.overshoot != scene::Simulation{}.overshoot ? 1U : 0U}}};
    for (const auto& [name, count] : all) {
        if (count > 0) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("/simulation/{}", name),
                         fmt::format("expected none, or its default, while frames are drawn, found {}", count),
                         "simulate into files first (sluice simulate SCENE -o FILE) and give them with --particles"};
        }
    }
    return {};
}

}  // namespace

SluiceSimulation LiveFluid::view() const {
    SluiceSimulation out = settings;
    out.solids = solids.data();
    out.solid_count = static_cast<std::uint32_t>(solids.size());
    out.position = start.position.data();
    out.velocity = start.velocity.data();
    out.particle_count = count();
    return out;
}

bool simulatesLive(const scene::Scene& scene) {
    return scene.particles.path.empty() && !(scene.simulation.fluid.empty() && scene.simulation.emitters.empty());
}

Result<LiveFluid> liveFluid(const scene::Scene& scene, std::uint64_t seed, std::uint32_t frames_in_flight) {
    const simulator::Setup setup = simulationSetup(scene);
    if (Status status = checkCrosses(setup, scene.simulation.meshes.size()); !status) {
        return status.error();
    }
    Result<simulator::Particles> start = startOfFluid(scene.simulation, setup, seed);
    if (!start) {
        return start.error();
    }
    LiveFluid live;
    live.start = std::move(start).value();
    live.solids = solidsOf(setup);
    live.frame_s = 1.0 / double{scene.simulation.frames_per_second};
    SluiceSimulation& s = live.settings;
    s.struct_size = sizeof(s);
    s.frames_in_flight = frames_in_flight;
    s.radius = setup.radius;
    std::copy(setup.low.begin(), setup.low.end(), &s.low[0]);
    std::copy(setup.high.begin(), setup.high.end(), &s.high[0]);
    std::copy(setup.gravity.begin(), setup.gravity.end(), &s.gravity[0]);
    s.iterations = setup.iterations;
    s.relaxation = setup.relaxation;
    s.tensile = setup.tensile;
    s.viscosity = setup.viscosity;
    s.vorticity = setup.vorticity;
    s.cfl = setup.cfl;
    s.longest_step = std::min(1.0, live.frame_s / scene.simulation.steps_per_frame);
    return live;
}

}  // namespace sluice::cli
