// SPDX-License-Identifier: MIT
// A closed surface of triangles that fluid stays out of. Pure: no Vulkan type.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/vector.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Of one mesh.
inline constexpr std::size_t kMostTriangles = 1'000'000;

/// Triangles turn counter-clockwise as seen from outside.
struct Mesh {
    std::string name;  ///< for messages
    std::vector<Vector> corners;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A triangle with the directions that tell inside from outside, whatever part of it is nearest.
struct MeshTriangle {
    std::array<Vector, 3> corner;
    Vector normal;  ///< unit, outwards
    /// Out of edge i (from corner i to the next), then out of corner i - 3 (Baerentzen & Aanaes 2005); any length.
    std::array<Vector, 6> outwards;
};

/// Corners in the same place count as one. Refused, with what is wrong named: no triangles or too many, a number that
/// is not finite, a triangle without area, an edge that does not join exactly two triangles of opposite direction, a
/// surface that is inside out.
[[nodiscard]] Result<std::vector<MeshTriangle>> closedTriangles(const Mesh& mesh);

}  // namespace sluice::vk
