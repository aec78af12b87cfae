// SPDX-License-Identifier: MIT
// Triangle meshes as distances at the nodes of a grid, between which they are interpolated. docs/simulation.md has the
// bounds. Pure: no Vulkan type.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "simulation/mesh.hpp"
#include "simulation/solid.hpp"

namespace sluice::vk {

/// Of one grid: 32 MiB.
inline constexpr std::uint64_t kMostNodes = 1U << 23;

/// Covers what of the domain is within a kernel's support of a mesh; elsewhere no mesh matters.
struct DistanceGrid {
    Vector low{};                         ///< where the first node is
    double spacing = 0.0;                 ///< m
    std::array<std::uint32_t, 3> size{};  ///< nodes along each axis, at least 2
    std::vector<float> nodes;             ///< distance to the nearest mesh, m, negative inside; x runs fastest
};

/// Two radii between nodes. Every mesh is checked (closedTriangles); no meshes, or none that reaches into the domain
/// between `low` and `high`, give a grid without nodes. Refused: more nodes, or more work, than is sensible.
[[nodiscard]] Result<DistanceGrid> distanceGrid(std::span<const Mesh> meshes, float radius, const Triple& low,
                                                const Triple& high);

/// Far away outside the grid. As solids.glsl has it.
[[nodiscard]] SolidContact contactWith(const DistanceGrid& grid, const Vector& x);

}  // namespace sluice::vk
