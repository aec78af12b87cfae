// SPDX-License-Identifier: MIT
#include "simulation/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace sluice::vk {
namespace {

/// From one corner to another, in the triangle that has it in this direction.
struct Edge {
    std::uint32_t from, to, triangle;
    [[nodiscard]] std::array<std::uint32_t, 2> ends() const { return {from, to}; }
};

constexpr auto kBefore = [](const Edge& a, const Edge& b) { return a.ends() < b.ends(); };

std::string shown(const Vector& v) {
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v[0], v[1], v[2]);
}

Error wrong(const Mesh& mesh, const std::string& found, const char* remedy) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, mesh.name, "expected a closed surface of triangles, found " + found, remedy};
}

/// The same triangles with one number for each place.
Result<std::vector<std::array<std::uint32_t, 3>>> welded(const Mesh& mesh) {
    std::map<Vector, std::uint32_t> first;
    std::vector<std::uint32_t> number;
    for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
        const Vector& x = mesh.corners[i];
        if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2])) {
            return wrong(mesh, fmt::format("corner {} at {}", i + 1, shown(x)), "every coordinate must be finite");
        }
        number.push_back(first.emplace(x, static_cast<std::uint32_t>(i)).first->second);
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const auto& triangle : mesh.triangles) {
        std::array<std::uint32_t, 3> to{};
        for (std::size_t i = 0; i < 3; ++i) {
            if (triangle.at(i) >= number.size()) {
                return wrong(mesh,
                             fmt::format("triangle {} with corner {} of {}", triangles.size() + 1, triangle.at(i) + 1,
                                         number.size()),
                             "a triangle names corners that the file has");
            }
            to.at(i) = number[triangle.at(i)];
        }
        triangles.push_back(to);
    }
    return triangles;
}

/// All edges in order, if each one is there once and its opposite too.
Result<std::vector<Edge>> pairedEdges(const Mesh& mesh, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    std::vector<Edge> edges;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            edges.push_back({triangles[t].at(i), triangles[t].at((i + 1) % 3), t});
        }
    }
    std::sort(edges.begin(), edges.end(), kBefore);
    const auto name = [&](const Edge& edge) {
        return fmt::format("the edge from {} to {}", shown(mesh.corners[edge.from]), shown(mesh.corners[edge.to]));
    };
    // First, as a triangle that is turned leaves edges alone as well.
    const auto twice = std::adjacent_find(edges.begin(), edges.end(),
                                          [](const Edge& a, const Edge& b) { return a.ends() == b.ends(); });
    if (twice != edges.end()) {
        return wrong(
            mesh,
            fmt::format("{} in triangle {} and, in the same direction, in triangle {}", name(*twice),
                        twice->triangle + 1, std::next(twice)->triangle + 1),
            "turn all triangles counter-clockwise as seen from outside (Blender: Recalculate Outside), and let "
            "an edge join two of them");
    }
    const auto alone = std::find_if(edges.begin(), edges.end(), [&](const Edge& edge) {
        return !std::binary_search(edges.begin(), edges.end(), Edge{edge.to, edge.from, 0}, kBefore);
    });
    if (alone != edges.end()) {
        return wrong(mesh, fmt::format("{} in triangle {} alone", name(*alone), alone->triangle + 1),
                     "close the hole (Blender: Merge by Distance, then Fill Holes)");
    }
    return edges;
}

double angle(const Vector& a, const Vector& b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
}

}  // namespace

Result<std::vector<MeshTriangle>> closedTriangles(const Mesh& mesh) {
    if (mesh.triangles.empty() || mesh.triangles.size() > kMostTriangles) {
        return wrong(mesh, fmt::format("{} triangles", mesh.triangles.size()),
                     mesh.triangles.empty() ? "the file has no faces" : "at most 1000000; simplify the mesh");
    }
    const auto triangles = welded(mesh);
    if (!triangles) {
        return triangles.error();
    }
    const auto edges = pairedEdges(mesh, triangles.value());
    if (!edges) {
        return edges.error();
    }
    std::vector<MeshTriangle> made;
    std::vector<Vector> about(mesh.corners.size(), Vector{});
    double volume = 0.0;
    for (const auto& triangle : triangles.value()) {
        MeshTriangle m{};
        std::transform(triangle.begin(), triangle.end(), m.corner.begin(),
                       [&](std::uint32_t corner) { return mesh.corners[corner]; });
        const Vector area = cross(minus(m.corner[1], m.corner[0]), minus(m.corner[2], m.corner[0]));
        double longest = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            longest = std::max(longest, length(minus(m.corner.at((i + 1) % 3), m.corner.at(i))));
        }
        if (!(length(area) > 1e-12 * longest * longest)) {
            return wrong(mesh, fmt::format("triangle {} at {} without an area", made.size() + 1, shown(m.corner[0])),
                         "dissolve degenerate faces (Blender: Mesh, Clean Up)");
        }
        m.normal = unit(area);
        volume += dot(minus(m.corner[0], mesh.corners[triangles.value().front()[0]]), area) / 6.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vector next = minus(m.corner.at((i + 1) % 3), m.corner.at(i));
            const Vector last = minus(m.corner.at((i + 2) % 3), m.corner.at(i));
            about[triangle.at(i)] = plus(about[triangle.at(i)], times(angle(next, last), m.normal));
        }
        made.push_back(m);
    }
    if (!(volume > 0.0)) {
        return wrong(mesh, fmt::format("one that is inside out, of volume {:.3g} m^3", volume),
                     "turn all triangles counter-clockwise as seen from outside (Blender: Recalculate Outside)");
    }
    for (std::size_t t = 0; t < made.size(); ++t) {
        const auto& triangle = triangles.value()[t];
        for (std::size_t i = 0; i < 3; ++i) {
            const Edge opposite{triangle.at((i + 1) % 3), triangle.at(i), 0};
            const auto other = std::lower_bound(edges.value().begin(), edges.value().end(), opposite, kBefore);
            made[t].outwards.at(i) = plus(made[t].normal, made[other->triangle].normal);
            made[t].outwards.at(3 + i) = about[triangle.at(i)];
        }
    }
    return made;
}

}  // namespace sluice::vk
