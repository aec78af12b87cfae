// SPDX-License-Identifier: MIT
// The arrays of a SluiceSimulation, for whoever checks, copies or carries them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "sluice/simulation_limits.hpp"

namespace sluice {

/// Calls each(name, array, elements, most) for every array, in the order in which they cross between processes; `array`
/// is a reference to the pointer. Elements are 4-byte words or made of them. `velocities`: whether there are any.
template <typename Simulation, typename Each>
void eachArray(Simulation& s, bool velocities, const Each& each) {
    const auto triples = [](std::uint32_t count) { return std::size_t{3} * count; };
    each("solids", s.solids, std::size_t{s.solid_count}, std::size_t{kMostSolids});
    each("position", s.position, triples(s.particle_count), triples(kMostSimulatedParticles));
    each("velocity", s.velocity, velocities ? triples(s.particle_count) : 0, triples(kMostSimulatedParticles));
    each("emitters", s.emitters, std::size_t{s.emitter_count}, std::size_t{SLUICE_MAX_EMITTERS});
    each("drains", s.drains, std::size_t{s.drain_count}, std::size_t{SLUICE_MAX_DRAINS});
    each("fields", s.fields, std::size_t{s.field_count}, std::size_t{SLUICE_MAX_FIELDS});
    each("bodies", s.bodies, std::size_t{s.body_count}, std::size_t{SLUICE_MAX_BODIES});
    each("path_points", s.path_points, std::size_t{s.path_point_count}, std::size_t{kMostPathPoints});
    each("meshes", s.meshes, std::size_t{s.mesh_count}, std::size_t{kMostMeshes});
    each("mesh_corners", s.mesh_corners, triples(s.mesh_corner_count), triples(kMostMeshCorners));
    each("mesh_indices", s.mesh_indices, triples(s.mesh_triangle_count), triples(kMostMeshTriangles));
    each("fluids", s.fluids, std::size_t{s.fluid_count}, std::size_t{SLUICE_MAX_FLUIDS});
    each("particle_fluids", s.particle_fluids, std::size_t{s.particle_fluid_count},
         std::size_t{kMostSimulatedParticles});
}

/// Every array is there and within its bound, and there is fluid or an emitter: what must hold before anything reads
/// them. `simulation` has passed readAbiStruct.
[[nodiscard]] Status checkArrays(const SluiceSimulation& simulation);

/// The same of what a simulation is reset to, but for whether there may be none. It has passed readAbiStruct.
[[nodiscard]] Status checkArrays(const SluiceStart& start);

/// UNSUPPORTED, with what it lacks named, if the simulation asks for more than a renderer of this table knows.
[[nodiscard]] Status checkServed(const SluiceSimulation& simulation, const SluiceRendererApi& api);
[[nodiscard]] Status checkServed(const SluiceFlow& flow, const SluiceRendererApi& api);

/// What a renderer that is made anew is to be told: `flow`, with the fluids of `before` where it names none, since
/// those flow on as they did.
[[nodiscard]] SluiceFlow flowAfter(const std::optional<SluiceFlow>& before, const SluiceFlow& flow);

}  // namespace sluice
