// SPDX-License-Identifier: MIT
#include "app/live_fluid.hpp"

#include <algorithm>
#include <utility>

#include "app/checked_setup.hpp"
#include "app/simulate_setup.hpp"
#include "app/start_file.hpp"

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

void put(float (&to)[3], const simulator::Vec3& from) {
    std::copy(from.begin(), from.end(), &to[0]);
}

void addSources(LiveFluid& live, const simulator::Setup& setup) {
    for (const simulator::Emitter& e : setup.emitters) {
        SluiceEmitter& to = live.emitters.emplace_back();
        to.shape = e.disc ? SLUICE_OPENING_DISC : SLUICE_OPENING_RECTANGLE;
        put(to.centre, e.centre);
        put(to.direction, e.direction);
        to.width = e.width;
        to.height = e.height;
        to.speed = e.speed;
        to.rate = e.rate;
        to.start = e.start;
        to.stop = e.stop;
        to.fluid = e.fluid;
    }
    for (const simulator::Drain& drain : setup.drains) {
        SluiceDrain& to = live.drains.emplace_back();
        to.shape = drain.sphere ? SLUICE_REGION_SPHERE : SLUICE_REGION_BOX;
        put(to.centre, drain.centre);
        put(to.half, drain.half);
    }
    for (const simulator::ForceField& f : setup.fields) {
        using Kind = simulator::ForceField::Kind;
        SluiceForceField& to = live.fields.emplace_back();
        to.kind = f.kind == Kind::Wind    ? SLUICE_FIELD_WIND
                  : f.kind == Kind::Point ? SLUICE_FIELD_POINT
                                          : SLUICE_FIELD_VORTEX;
        put(to.centre, f.centre);
        put(to.axis, f.axis);
        to.strength = f.strength;
        to.radius = f.radius;
    }
}

void addBodies(LiveFluid& live, const simulator::Setup& setup) {
    for (const simulator::Body& b : setup.bodies) {
        using Shape = simulator::Body::Shape;
        SluiceBody& to = live.bodies.emplace_back();
        to.shape = b.shape == Shape::Sphere    ? SLUICE_SOLID_SPHERE
                   : b.shape == Shape::Capsule ? SLUICE_SOLID_CAPSULE
                                               : SLUICE_SOLID_BOX;
        to.motion = b.path.empty() ? SLUICE_BODY_FREE : SLUICE_BODY_PATH;
        put(to.centre, b.centre);
        put(to.half, b.half);
        to.turn_degrees = b.turn_degrees;
        to.density = b.density;
        put(to.velocity, b.velocity);
        put(to.spin, b.spin);
        to.path_first = static_cast<std::uint32_t>(live.path_points.size());
        to.path_count = static_cast<std::uint32_t>(b.path.size());
        for (const simulator::PathPoint& point : b.path) {
            SluicePathPoint& at = live.path_points.emplace_back();
            at.time = point.time;
            put(at.centre, point.centre);
            at.turn_degrees = point.turn_degrees;
        }
    }
}

void addMeshes(LiveFluid& live, const std::vector<simulator::Mesh>& meshes) {
    for (const simulator::Mesh& mesh : meshes) {
        live.meshes.push_back(
            {static_cast<std::uint32_t>(mesh.corners.size()), static_cast<std::uint32_t>(mesh.triangles.size()), {}});
        for (const auto& x : mesh.corners) {
            for (const double coordinate : x) {
                live.mesh_corners.push_back(static_cast<float>(coordinate));
            }
        }
        for (const auto& triangle : mesh.triangles) {
            live.mesh_indices.insert(live.mesh_indices.end(), triangle.begin(), triangle.end());
        }
    }
}

template <typename T>
std::uint32_t countOf(const std::vector<T>& items, std::size_t each = 1) {
    return static_cast<std::uint32_t>(items.size() / each);
}

}  // namespace

SluiceSimulation LiveFluid::view() const {
    SluiceSimulation out = settings;
    out.solids = solids.data();
    out.solid_count = static_cast<std::uint32_t>(solids.size());
    out.position = start.position.data();
    out.velocity = start.velocity.data();
    out.particle_count = count();
    out.emitters = emitters.data();
    out.emitter_count = countOf(emitters);
    out.drains = drains.data();
    out.drain_count = countOf(drains);
    out.fields = fields.data();
    out.field_count = countOf(fields);
    out.bodies = bodies.data();
    out.body_count = countOf(bodies);
    out.path_points = path_points.data();
    out.path_point_count = countOf(path_points);
    out.meshes = meshes.data();
    out.mesh_count = countOf(meshes);
    out.mesh_corners = mesh_corners.data();
    out.mesh_corner_count = countOf(mesh_corners, 3);
    out.mesh_indices = mesh_indices.data();
    out.mesh_triangle_count = countOf(mesh_indices, 3);
    out.fluids = fluids.data();
    out.fluid_count = countOf(fluids);
    out.particle_fluids = start.fluid.data();
    out.particle_fluid_count = countOf(start.fluid);
    return out;
}

bool simulatesLive(const scene::Scene& scene) {
    return scene.particles.path.empty() && hasFluid(scene.simulation);
}

Result<LiveFluid> liveFluid(const scene::Scene& scene, const std::vector<simulator::Mesh>& meshes,
                            const LiveRequest& request) {
    const bool by_depth = scene.simulation.collide == scene::kCollideDepth;
    const Result<simulator::Setup> checked = checkedSetup(scene, meshes);
    if (!checked) {
        return checked.error();
    }
    const simulator::Setup& setup = checked.value();
    Result<simulator::Particles> start = wholeStart(scene.simulation, setup, request.seed);
    if (!start) {
        return start.error();
    }
    LiveFluid live;
    live.start = std::move(start).value();
    live.solids = solidsOf(setup);
    addSources(live, setup);
    addBodies(live, setup);
    for (const simulator::Fluid& f : setup.fluids) {
        live.fluids.push_back({f.density, f.viscosity, f.tension, f.adhesion, {}});
    }
    if (!by_depth) {
        addMeshes(live, meshes);
    }
    live.frame_s = 1.0 / double{scene.simulation.frames_per_second};
    SluiceSimulation& s = live.settings;
    s.struct_size = sizeof(s);
    s.frames_in_flight = request.frames_in_flight;
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
    s.tension = setup.tension;
    s.adhesion = setup.adhesion;
    s.overshoot = setup.overshoot > 0.0F ? setup.overshoot : -1.0F;
    // What emitters could give by the last frame, and no more than `sluice simulate` takes: slots for all of that would
    // be gigabytes.
    const double most =
        simulator::mostParticles(setup, live.count(), static_cast<double>(request.last_frame) * live.frame_s);
    s.max_particles = static_cast<std::uint32_t>(std::clamp(most, 1.0, static_cast<double>(kMostSimulated)));
    s.anisotropy = scene.simulation.anisotropy.ratio;
    s.smoothing = scene.simulation.anisotropy.smoothing;
    s.lonely = scene.simulation.anisotropy.lonely;
    s.density_kernel = scene.simulation.kernel;
    const scene::Foam& foam = scene.simulation.foam;
    s.foam_life = foam.life;
    s.foam_air[0] = foam.air_low;
    s.foam_air[1] = foam.air_high;
    s.foam_crest[0] = foam.crest_low;
    s.foam_crest[1] = foam.crest_high;
    s.foam_energy[0] = foam.energy_low;
    s.foam_energy[1] = foam.energy_high;
    s.longest_step = std::min(1.0, live.frame_s / scene.simulation.steps_per_frame);
    if (by_depth) {
        s.depth_scale = scene.simulation.depth.scale;
        s.depth_lag = 1;  // the picture before, whatever is in flight: the pictures are the same then
        s.depth_thickness = scene.simulation.depth.thickness;
    }
    return live;
}

}  // namespace sluice::cli
