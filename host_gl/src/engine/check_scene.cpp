// SPDX-License-Identifier: MIT
#include "engine/check_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace sluice::host {

Status checkScene(const EngineScene& scene) {
    const auto bad = [](std::string thing, std::string detail) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, std::move(thing), std::move(detail), "correct the scene"};
    };
    if (!(scene.floor_half_extent > 0.0F) || !std::isfinite(scene.floor_half_extent)) {
        return bad("floor half extent", fmt::format("{} m, must be positive", scene.floor_half_extent));
    }
    if (!(scene.fog_density >= 0.0F)) {
        return bad("fog density", fmt::format("{} per metre, must not be negative", scene.fog_density));
    }
    for (std::size_t i = 0; i < scene.pillars.size(); ++i) {
        const Pillar& p = scene.pillars[i];
        if (!(p.radius > 0.0F) || !(p.height > 0.0F)) {
            return bad(fmt::format("pillar {}", i),
                       fmt::format("radius {} m and height {} m must be positive", p.radius, p.height));
        }
    }
    for (std::size_t i = 0; i < scene.crates.size(); ++i) {
        if (!(scene.crates[i].size > 0.0F)) {
            return bad(fmt::format("crate {}", i), fmt::format("size {} m, must be positive", scene.crates[i].size));
        }
    }
    for (std::size_t i = 0; i < scene.basins.size(); ++i) {
        const Basin& b = scene.basins[i];
        if (!(b.half_x > 0.0F) || !(b.half_z > 0.0F) || !(b.height > 0.0F) || !(b.wall > 0.0F)) {
            return bad(fmt::format("basin {}", i),
                       fmt::format("half extents {} and {} m, height {} m and wall {} m must be positive", b.half_x,
                                   b.half_z, b.height, b.wall));
        }
    }
    for (std::size_t i = 0; i < scene.banners.size(); ++i) {
        const Banner& b = scene.banners[i];
        const float along = std::hypot(b.to[0] - b.from[0], b.to[1] - b.from[1], b.to[2] - b.from[2]);
        if (!(along > 0.0F) || !(b.drop > 0.0F) || b.cells < 1 || b.cells > kMostBannerCells || b.iterations > 1000) {
            return bad(fmt::format("banner {}", i),
                       fmt::format("from {} m to and drop {} m must be positive, {} cells within 1..{}, {} iterations "
                                   "at most 1000",
                                   along, b.drop, b.cells, kMostBannerCells, b.iterations));
        }
    }
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        for (const auto& triangle : scene.meshes[i].triangles) {
            if (std::max({triangle[0], triangle[1], triangle[2]}) >= scene.meshes[i].corners.size()) {
                return bad(fmt::format("mesh {}", i),
                           fmt::format("a triangle names a corner of {}", scene.meshes[i].corners.size()));
            }
        }
    }
    return {};
}

}  // namespace sluice::host
