// SPDX-License-Identifier: MIT
#include "simulation/depth_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sluice::vk {
namespace {

Error wrong(const std::string& expected, const std::string& found) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, "simulation: depth field",
            fmt::format("expected {}, found {}", expected, found), ""};
}

std::uint32_t texelsOf(std::uint32_t pixels, std::uint32_t scale) {
    return (pixels + scale - 1) / scale;
}

bool finite(const std::array<float, 16>& matrix) {
    return std::all_of(matrix.begin(), matrix.end(), [](float value) { return std::isfinite(value); });
}

}  // namespace

Status checkDepthView(const DepthView& camera) {
    const auto& v = camera.view;
    const auto& p = camera.projection;
    if (!finite(v) || !finite(p) || !(camera.near_plane > 0.0F) || !std::isfinite(camera.near_plane)) {
        return wrong("finite matrices and a near plane > 0",
                     fmt::format("NaN or infinity, or a near plane of {}", camera.near_plane));
    }
    Vector axes[3];
    for (std::size_t row = 0; row < 3; ++row) {
        axes[row] = {double{v.at(row)}, double{v.at(4 + row)}, double{v.at(8 + row)}};
    }
    double off = std::abs(dot(axes[0], cross(axes[1], axes[2])) - 1.0);
    for (std::size_t row = 0; row < 3; ++row) {
        off = std::max({off, std::abs(dot(axes[row], axes[row]) - 1.0), std::abs(dot(axes[row], axes[(row + 1) % 3]))});
    }
    off = std::max(
        {off, std::abs(double{v[3]}), std::abs(double{v[7]}), std::abs(double{v[11]}), std::abs(double{v[15]} - 1.0)});
    if (off > 1e-3) {
        return wrong("a view that only turns and moves", fmt::format("one that is {:.3g} off", off));
    }
    if (p[3] != 0.0F || p[7] != 0.0F || p[15] != 0.0F || !(p[11] < 0.0F) || p[0] == 0.0F || p[5] == 0.0F ||
        p[1] != 0.0F || p[4] != 0.0F) {
        return wrong("an OpenGL perspective", fmt::format("[{}, {}; {}, {}] and a last row of [{}, {}, {}, {}]", p[0],
                                                          p[4], p[1], p[5], p[3], p[7], p[11], p[15]));
    }
    return {};
}

Status checkDepthField(const DepthField& field, float radius) {
    const std::uint64_t texels = std::uint64_t{field.width} * field.height;
    const auto fits = [](float view, std::uint32_t size) {
        return view > static_cast<float>(size) - 1.0F && view <= static_cast<float>(size);
    };
    if (texels > kMostSeenTexels || field.depth.size() != texels ||
        (texels > 0 && !(fits(field.view_size[0], field.width) && fits(field.view_size[1], field.height)))) {
        return wrong(fmt::format("at most {} texels, all given", kMostSeenTexels),
                     fmt::format("{}x{} and {} depths", field.width, field.height, field.depth.size()));
    }
    if (texels == 0) {
        return {};
    }
    const float thinnest = radius;
    if (!(field.thickness >= thinnest && field.thickness <= 1e6F)) {
        return wrong(fmt::format("a thickness of {} m (a radius) or more", thinnest),
                     fmt::format("{}", field.thickness));
    }
    return checkDepthView(field.camera);
}

DepthHeader depthHeader(const DepthField& field) {
    DepthHeader header = depthHeader(field.camera, field.width, field.height, 1, field.thickness);
    std::copy(field.view_size.begin(), field.view_size.end(), header.limits.begin() + 2);
    return header;
}

DepthHeader depthHeader(const DepthView& camera, std::uint32_t width, std::uint32_t height, std::uint32_t scale,
                        float thickness) {
    DepthHeader header;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 4; ++column) {
            header.rows.at(row).at(column) = camera.view.at(4 * column + row);
        }
    }
    const auto& p = camera.projection;
    const float s = p[11] != 0.0F ? -p[11] : 1.0F;
    header.lens = {p[0] / s, p[5] / s, p[8] / s, p[9] / s};
    const auto parts = static_cast<float>(scale);
    header.limits = {camera.near_plane, thickness, static_cast<float>(width) / parts,
                     static_cast<float>(height) / parts};
    header.size = {texelsOf(width, scale), texelsOf(height, scale), 0, 0};
    return header;
}

DepthField depthField(const DepthView& camera, std::uint32_t width, std::uint32_t height, std::uint32_t scale,
                      float thickness, const std::vector<float>& depths) {
    const DepthHeader header = depthHeader(camera, width, height, scale, thickness);
    DepthField field{header.size[0], header.size[1], {header.limits[2], header.limits[3]}, camera, thickness, {}};
    field.depth.assign(std::size_t{field.width} * field.height, 1e30F);
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            const float depth = depths[y * width + x];
            float& least = field.depth[y / scale * field.width + x / scale];
            if (std::isfinite(depth) && depth > 0.0F) {
                least = std::min(least, depth);
            }
        }
    }
    return field;
}

}  // namespace sluice::vk
