// SPDX-License-Identifier: MIT
#include "plugin/simulation_arrays.hpp"

#include <fmt/format.h>

#include <memory>
#include <span>
#include <string>
#include <utility>

namespace sluice::vk {
namespace {

static_assert(kMaxEmitters == SLUICE_MAX_EMITTERS && kMaxDrains == SLUICE_MAX_DRAINS &&
              kMaxFields == SLUICE_MAX_FIELDS && kMaxBodies == SLUICE_MAX_BODIES && kMaxFluids == SLUICE_MAX_FLUIDS);

Error unknown(const char* array, std::size_t index, const char* what, std::uint32_t value) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("simulation.{}", array),
            fmt::format("number {} has {} {}, which there is not", index, what, value), ""};
}

Error beyond(const std::string& thing, const char* what, std::uint64_t end, std::uint64_t there) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, thing, fmt::format("its {} end at {}, and there are {}", what, end, there),
            ""};
}

Result<Body> bodyOf(const SluiceSimulation& s, std::size_t index) {
    const SluiceBody& given = s.bodies[index];
    Body body;
    switch (given.shape) {
        case SLUICE_SOLID_SPHERE:
            body.shape = SolidKind::Sphere;
            break;
        case SLUICE_SOLID_CAPSULE:
            body.shape = SolidKind::Capsule;
            break;
        case SLUICE_SOLID_BOX:
            body.shape = SolidKind::Box;
            break;
        default:
            return unknown("bodies", index, "the shape", given.shape);
    }
    if (given.motion > SLUICE_BODY_DRIVEN) {
        return unknown("bodies", index, "the motion", given.motion);
    }
    const std::string thing = fmt::format("simulation.bodies: number {}", index);
    const std::uint64_t end = std::uint64_t{given.path_first} + given.path_count;
    if (end > s.path_point_count) {
        return beyond(thing, "path points", end, s.path_point_count);
    }
    if ((given.motion == SLUICE_BODY_PATH) != (given.path_count > 0)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, thing,
                     fmt::format("has the motion {} and {} path points", given.motion, given.path_count),
                     "give SLUICE_BODY_PATH points, and no other motion"};
    }
    body.centre = triple(given.centre);
    body.half = triple(given.half);
    body.turn_degrees = given.turn_degrees;
    body.density = given.motion == SLUICE_BODY_FREE ? given.density : 1.0F;
    body.velocity = triple(given.velocity);
    body.spin = triple(given.spin);
    body.driven = given.motion == SLUICE_BODY_DRIVEN;
    for (std::uint64_t i = given.path_first; i < end; ++i) {
        const SluicePathPoint& point = s.path_points[i];
        body.path.push_back({point.time, triple(point.centre), point.turn_degrees});
    }
    return body;
}

}  // namespace

std::vector<Fluid> readFluids(const SluiceFluidKind* fluids, std::size_t count) {
    std::vector<Fluid> read;
    for (const SluiceFluidKind& fluid : std::span(fluids, count)) {
        read.push_back({fluid.density, fluid.viscosity, fluid.tension, fluid.adhesion});
    }
    return read;
}

Status readSources(const SluiceSimulation& simulation, SourceSettings& sources) {
    const SluiceSimulation& s = simulation;
    for (std::size_t i = 0; i < s.emitter_count; ++i) {
        const SluiceEmitter& e = s.emitters[i];
        if (e.shape > SLUICE_OPENING_RECTANGLE) {
            return unknown("emitters", i, "the shape", e.shape);
        }
        sources.emitters.push_back({e.shape == SLUICE_OPENING_DISC, triple(e.centre), triple(e.direction), e.width,
                                    e.height, e.speed, e.rate, e.start, e.stop, e.fluid});
    }
    for (std::size_t i = 0; i < s.drain_count; ++i) {
        const SluiceDrain& drain = s.drains[i];
        if (drain.shape > SLUICE_REGION_BOX) {
            return unknown("drains", i, "the shape", drain.shape);
        }
        sources.drains.push_back({drain.shape == SLUICE_REGION_SPHERE, triple(drain.centre), triple(drain.half)});
    }
    for (std::size_t i = 0; i < s.field_count; ++i) {
        const SluiceForceField& f = s.fields[i];
        if (f.kind > SLUICE_FIELD_VORTEX) {
            return unknown("fields", i, "the kind", f.kind);
        }
        const ForceKind kind = f.kind == SLUICE_FIELD_WIND    ? ForceKind::Wind
                               : f.kind == SLUICE_FIELD_POINT ? ForceKind::Point
                                                              : ForceKind::Vortex;
        sources.fields.push_back({kind, triple(f.centre), triple(f.axis), f.strength, f.radius});
    }
    if (s.emitter_count > 0) {
        sources.most_particles = s.max_particles;
    }
    return {};
}

Result<std::vector<Body>> readBodies(const SluiceSimulation& simulation) {
    std::vector<Body> bodies;
    for (std::size_t i = 0; i < simulation.body_count; ++i) {
        Result<Body> body = bodyOf(simulation, i);
        if (!body) {
            return body.error();
        }
        bodies.push_back(std::move(body).value());
    }
    return bodies;
}

Status readMeshes(const SluiceSimulation& simulation, SimulationSettings& settings) {
    const SluiceSimulation& s = simulation;
    if (Status status = checkSettings(settings); !status) {
        return status;  // the distances are as fine as the radius, and as wide as the domain
    }
    std::vector<Mesh> meshes;
    std::uint64_t corner = 0;
    std::uint64_t triangle = 0;
    for (std::size_t i = 0; i < s.mesh_count; ++i) {
        const SluiceMesh given = s.meshes[i];
        Mesh mesh;
        mesh.name = fmt::format("simulation.meshes: number {}", i);
        if (corner + given.corner_count > s.mesh_corner_count) {
            return beyond(mesh.name, "corners", corner + given.corner_count, s.mesh_corner_count);
        }
        if (triangle + given.triangle_count > s.mesh_triangle_count) {
            return beyond(mesh.name, "triangles", triangle + given.triangle_count, s.mesh_triangle_count);
        }
        for (const std::uint64_t end = corner + given.corner_count; corner < end; ++corner) {
            const float* x = s.mesh_corners + 3 * corner;
            mesh.corners.push_back({double{x[0]}, double{x[1]}, double{x[2]}});
        }
        for (const std::uint64_t end = triangle + given.triangle_count; triangle < end; ++triangle) {
            const std::uint32_t* corners = s.mesh_indices + 3 * triangle;
            mesh.triangles.push_back({corners[0], corners[1], corners[2]});
        }
        meshes.push_back(std::move(mesh));
    }
    Result<DistanceGrid> grid = distanceGrid(meshes, settings.radius, settings.low, settings.high);
    if (!grid) {
        return grid.error();
    }
    settings.meshes = std::make_shared<const DistanceGrid>(std::move(grid).value());
    return {};
}

}  // namespace sluice::vk
