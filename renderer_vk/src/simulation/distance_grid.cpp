// SPDX-License-Identifier: MIT
#include "simulation/distance_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sluice::vk {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNobody = ~0U;
/// Distances of a triangle to a node that one mesh may ask for: some minutes.
constexpr double kMostWork = 4e9;

using Range = std::array<std::array<std::uint32_t, 2>, 3>;  ///< first node and the one behind the last, of each axis
struct Box {
    Vector low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
};

void include(Box& box, const Vector& x) {
    for (std::size_t i = 0; i < 3; ++i) {
        box.low[i] = std::min(box.low[i], x[i]);
        box.high[i] = std::max(box.high[i], x[i]);
    }
}

/// Distance from x to the triangle, negative on its inner side.
double signedDistance(const MeshTriangle& triangle, const Vector& x) {
    std::array<Vector, 3> from{};
    bool above = true;
    for (std::size_t i = 0; i < 3; ++i) {
        from[i] = minus(x, triangle.corner[i]);
        const Vector edge = minus(triangle.corner[(i + 1) % 3], triangle.corner[i]);
        above = above && dot(cross(triangle.normal, edge), from[i]) >= 0.0;
    }
    if (above) {
        return dot(triangle.normal, from[0]);
    }
    double nearest = kFar;
    double side = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        const Vector edge = minus(triangle.corner[next], triangle.corner[i]);
        const double along = std::clamp(dot(from[i], edge) / dot(edge, edge), 0.0, 1.0);
        const Vector away = minus(from[i], times(along, edge));
        if (const double square = dot(away, away); square < nearest) {
            nearest = square;
            const std::size_t part = along <= 0.0 ? 3 + i : (along >= 1.0 ? 3 + next : i);
            side = dot(away, triangle.outwards.at(part));
        }
    }
    return std::copysign(std::sqrt(nearest), side);
}

/// One mesh on the nodes of a grid.
struct Field {
    const DistanceGrid& grid;
    std::vector<double> distance;        ///< signed
    std::vector<std::uint32_t> nearest;  ///< triangle

    [[nodiscard]] Vector node(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return plus(grid.low, times(grid.spacing,
                                    Vector{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
    }
    [[nodiscard]] std::size_t at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return (std::size_t{z} * grid.size[1] + y) * grid.size[0] + x;
    }
};

Range around(const DistanceGrid& grid, const MeshTriangle& triangle, double band) {
    Box box;
    for (const Vector& corner : triangle.corner) {
        include(box, corner);
    }
    Range range{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double most = grid.size.at(i);
        const double first = std::ceil((box.low[i] - band - grid.low[i]) / grid.spacing);
        const double behind = std::floor((box.high[i] + band - grid.low[i]) / grid.spacing) + 1.0;
        range.at(i) = {static_cast<std::uint32_t>(std::clamp(first, 0.0, most)),
                       static_cast<std::uint32_t>(std::clamp(behind, 0.0, most))};
    }
    return range;
}

/// Exact distances for nodes within the band.
void fillBand(Field& field, const std::vector<MeshTriangle>& triangles, const std::vector<Range>& ranges, double band) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto& [xs, ys, zs] = ranges[t];
        for (std::uint32_t z = zs[0]; z < zs[1]; ++z) {
            for (std::uint32_t y = ys[0]; y < ys[1]; ++y) {
                for (std::uint32_t x = xs[0]; x < xs[1]; ++x) {
                    const Vector place = field.node(x, y, z);
                    double& known = field.distance[field.at(x, y, z)];
                    const double most = std::min(std::abs(known), band);
                    if (std::abs(dot(triangles[t].normal, minus(place, triangles[t].corner[0]))) > most) {
                        continue;
                    }
                    const double found = signedDistance(triangles[t], place);
                    if (std::abs(found) <= most && std::abs(found) < std::abs(known)) {
                        known = found;
                        field.nearest[field.at(x, y, z)] = t;
                    }
                }
            }
        }
    }
}

/// From the band outwards and inwards: the side of the neighbour that was there first, since the surface is farther
/// away than a node; the distance to the nearest triangle of any neighbour, which is never too small.
void flood(Field& field, const std::vector<MeshTriangle>& triangles) {
    const auto& size = field.grid.size;
    std::vector<std::size_t> queue;
    for (std::size_t i = 0; i < field.nearest.size(); ++i) {
        if (field.nearest[i] != kNobody) {
            queue.push_back(i);
        }
    }
    if (queue.empty()) {  // all on one side of the mesh
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            const double found = signedDistance(triangles[t], field.grid.low);
            if (std::abs(found) < std::abs(field.distance[0])) {
                field.distance[0] = found;
                field.nearest[0] = t;
            }
        }
        queue.push_back(0);
    }
    const std::size_t fixed = queue.size();
    std::vector<bool> in_band(field.nearest.size());
    for (std::size_t i = 0; i < fixed; ++i) {
        in_band[queue[i]] = true;
    }
    for (std::size_t next = 0; next < queue.size(); ++next) {
        const std::size_t here = queue[next];
        const std::array<std::size_t, 3> step{1, size[0], std::size_t{size[0]} * size[1]};
        const std::array<std::size_t, 3> place{here % size[0], here / size[0] % size[1], here / step[2]};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const bool up : {false, true}) {
                if (up ? place.at(axis) + 1 == size.at(axis) : place.at(axis) == 0) {
                    continue;
                }
                const std::size_t there = up ? here + step.at(axis) : here - step.at(axis);
                if (in_band[there]) {
                    continue;
                }
                const Vector x = field.node(static_cast<std::uint32_t>(there % size[0]),
                                            static_cast<std::uint32_t>(there / size[0] % size[1]),
                                            static_cast<std::uint32_t>(there / step[2]));
                const double found = std::abs(signedDistance(triangles[field.nearest[here]], x));
                const bool seen = field.nearest[there] != kNobody;
                if (!seen || found < std::abs(field.distance[there])) {
                    field.distance[there] = std::copysign(found, field.distance[here]);
                    field.nearest[there] = field.nearest[here];
                }
                if (!seen) {
                    queue.push_back(there);
                }
            }
        }
    }
}

/// Makes the nodes no farther than this mesh's surface.
Status addMesh(DistanceGrid& grid, const Mesh& mesh, const std::vector<MeshTriangle>& triangles, double band) {
    std::vector<Range> ranges;
    double work = 0.0;
    for (const MeshTriangle& triangle : triangles) {
        ranges.push_back(around(grid, triangle, band));
        double nodes = 1.0;
        for (const auto& [first, behind] : ranges.back()) {
            nodes *= behind > first ? static_cast<double>(behind - first) : 0.0;
        }
        work += nodes;
    }
    if (work > kMostWork) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, mesh.name,
                     fmt::format("{} triangles near {} nodes, {} m apart, need {:.1e} distances, more than {:.0e}",
                                 triangles.size(), grid.nodes.size(), grid.spacing, work, kMostWork),
                     "simplify the mesh, or make /simulation/radius larger"};
    }
    Field field{grid, std::vector<double>(grid.nodes.size(), kFar),
                std::vector<std::uint32_t>(grid.nodes.size(), kNobody)};
    fillBand(field, triangles, ranges, band);
    flood(field, triangles);
    std::transform(grid.nodes.begin(), grid.nodes.end(), field.distance.begin(), grid.nodes.begin(),
                   [](float before, double now) { return std::min(before, static_cast<float>(now)); });
    return {};
}

}  // namespace

Result<DistanceGrid> distanceGrid(std::span<const Mesh> meshes, float radius, const Triple& low, const Triple& high) {
    DistanceGrid grid;
    grid.spacing = 2.0 * double{radius};
    // Where the kernels reach, and the diagonal of a cell more, so that all eight nodes of any cell there are exact.
    const double band = 4.0 * double{radius} + 2.0 * grid.spacing;
    Box box;
    std::vector<std::vector<MeshTriangle>> all;
    for (const Mesh& mesh : meshes) {
        Result<std::vector<MeshTriangle>> triangles = closedTriangles(mesh);
        if (!triangles) {
            return triangles.error();
        }
        for (const MeshTriangle& triangle : triangles.value()) {
            std::for_each(triangle.corner.begin(), triangle.corner.end(), [&](const Vector& x) { include(box, x); });
        }
        all.push_back(std::move(triangles).value());
    }
    double nodes = 1.0;
    std::array<double, 3> size{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double first = std::max(box.low[i] - band, double{low[i]});
        const double last = std::min(box.high[i] + band, double{high[i]});
        if (!(first < last)) {
            return DistanceGrid{};
        }
        grid.low[i] = first;
        size.at(i) = std::ceil((last - first) / grid.spacing) + 1.0;
        nodes *= size.at(i);
    }
    if (nodes > static_cast<double>(kMostNodes)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, meshes.front().name,
                     fmt::format("a grid of {:.0f} nodes, {} m apart, about the meshes is more than {}", nodes,
                                 grid.spacing, kMostNodes),
                     "make the meshes or the domain smaller, or /simulation/radius larger"};
    }
    std::transform(size.begin(), size.end(), grid.size.begin(),
                   [](double number) { return static_cast<std::uint32_t>(number); });
    grid.nodes.assign(static_cast<std::size_t>(nodes), std::numeric_limits<float>::max());
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (Status status = addMesh(grid, meshes[i], all[i], band); !status) {
            return status.error();
        }
    }
    return grid;
}

SolidContact contactWith(const DistanceGrid& grid, const Vector& x) {
    std::array<std::size_t, 3> cell{};
    Vector part{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double at = (x[i] - grid.low[i]) / grid.spacing;
        if (grid.nodes.empty() || !(at >= 0.0 && at <= static_cast<double>(grid.size.at(i) - 1))) {
            return {{0, 1, 0}, 1e9};
        }
        cell.at(i) = std::min(static_cast<std::size_t>(at), std::size_t{grid.size.at(i)} - 2);
        part[i] = at - static_cast<double>(cell.at(i));
    }
    SolidContact contact{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const std::array<std::size_t, 3> up{corner & 1U, corner >> 1U & 1U, corner >> 2U};
        Vector weight{};
        for (std::size_t i = 0; i < 3; ++i) {
            weight[i] = up.at(i) == 1 ? part[i] : 1.0 - part[i];
        }
        const auto value =
            double{grid.nodes[((cell[2] + up[2]) * grid.size[1] + cell[1] + up[1]) * grid.size[0] + cell[0] + up[0]]};
        contact.distance += weight[0] * weight[1] * weight[2] * value;
        for (std::size_t i = 0; i < 3; ++i) {
            const double slope = weight[(i + 1) % 3] * weight[(i + 2) % 3] * value;
            contact.normal[i] += up.at(i) == 1 ? slope : -slope;
        }
    }
    const double steepness = length(contact.normal);
    contact.normal = steepness > 1e-20 ? times(1.0 / steepness, contact.normal) : Vector{0, 1, 0};
    return contact;
}

}  // namespace sluice::vk
