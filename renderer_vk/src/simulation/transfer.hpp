// SPDX-License-Identifier: MIT
// Particles to and from the solver's buffers, by identity: the order in which they were given.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simulation/buffers.hpp"
#include "simulation/solver.hpp"

namespace sluice::vk {

/// Low corner and 1 / spacing, sizes, nodes; one node where there are no meshes.
[[nodiscard]] Result<Buffer> uploadMeshes(const Device& device, const DistanceGrid& grid);
/// Header and depths; room for one depth at least.
[[nodiscard]] Result<Buffer> uploadDepthField(const Device& device, const DepthField& field);
/// Into the In buffers of the even state. Velocities and numbers of fluids: empty or as many.
[[nodiscard]] Status uploadParticles(const Device& device, const SimulationBuffers& buffers,
                                     std::span<const float> positions, std::span<const float> velocities,
                                     std::span<const std::uint32_t> fluids);
/// The state, from buffers to larger ones.
[[nodiscard]] Status copyParticles(const Device& device, const SimulationBuffers& from, const SimulationBuffers& to,
                                   std::uint32_t count, bool odd);
/// Without those that are gone.
[[nodiscard]] Result<ParticleState> downloadParticles(const Device& device, const SimulationBuffers& buffers,
                                                      std::uint32_t count, bool odd);
/// What the Measure pass has left.
[[nodiscard]] Result<std::vector<float>> downloadDensities(const Device& device, const SimulationBuffers& buffers,
                                                           std::uint32_t count, bool odd);
[[nodiscard]] Result<NeighbourLists> downloadLists(const Device& device, const SimulationBuffers& buffers,
                                                   std::uint32_t count, bool odd);

}  // namespace sluice::vk
