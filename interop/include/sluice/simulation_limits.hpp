// SPDX-License-Identifier: MIT
// How much a SluiceSimulation may hold: checked before anything reads or copies its arrays.
#pragma once

#include <cstdint>

namespace sluice {

/// 12 bytes each in the output slots and 30 times that in the solver: more fits no device.
inline constexpr std::uint32_t kMostSimulatedParticles = 1U << 28;
inline constexpr std::uint32_t kMostSolids = 1U << 16;
inline constexpr std::uint32_t kMostPathPoints = 1U << 16;
/// Of all meshes together.
inline constexpr std::uint32_t kMostMeshes = 1U << 10, kMostMeshCorners = 1U << 22, kMostMeshTriangles = 1U << 22;

}  // namespace sluice
