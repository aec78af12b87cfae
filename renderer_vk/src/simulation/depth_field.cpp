// SPDX-License-Identifier: MIT
#include "simulation/depth_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sluice::vk {
namespace {

/// What depth may change by from texel to texel, of what it does on a plane seen at 45 degrees.
constexpr double kSteepest = 32.0;
/// Below this part of a ray the distance to a plane is counted along the ray.
constexpr double kGrazing = 0.25;
constexpr double kLeastFacing = 1.0 / 64.0;

using Texel = std::array<std::int64_t, 2>;

double at(const DepthField& field, const Texel& texel) {
    if (texel[0] < 0 || texel[1] < 0 || texel[0] >= field.width || texel[1] >= field.height) {
        return 0.0;
    }
    const auto depth =
        double{field.depth[static_cast<std::size_t>(texel[1]) * field.width + static_cast<std::size_t>(texel[0])]};
    return std::isfinite(depth) && depth >= 0.5 * double{field.camera.near_plane} && depth <= 1e29 ? depth : 0.0;
}

struct Lens {
    std::array<double, 2> scale{}, offset{}, size{};

    [[nodiscard]] Vector ray(const Texel& texel) const {
        Vector way{0.0, 0.0, -1.0};
        for (std::size_t i = 0; i < 2; ++i) {
            way.at(i) =
                ((static_cast<double>(texel.at(i)) + 0.5) * 2.0 / size.at(i) - 1.0 + offset.at(i)) / scale.at(i);
        }
        return way;
    }
};

Vector tangent(const DepthField& field, const Lens& lens, const Texel& texel, std::size_t axis, double depth) {
    Texel after = texel;
    Texel before = texel;
    ++after.at(axis);
    --before.at(axis);
    const double ahead = at(field, after);
    const double behind = at(field, before);
    bool forward = behind <= 0.0;
    if (ahead > 0.0 && behind > 0.0) {
        // Where 1 / depth, which is linear on a plane, bends less; of two sides that both break off, the nearer depth.
        const auto changeTo = [&](double there) { return std::abs(1.0 / there - 1.0 / depth); };
        const auto bendOf = [&](double there, Texel beyond, std::int64_t by) {
            beyond.at(axis) += by;
            const double second = at(field, beyond);
            return second > 0.0 ? std::abs(2.0 / there - 1.0 / second - 1.0 / depth) : 1e9;
        };
        const double bend[2] = {bendOf(ahead, after, 1), bendOf(behind, before, -1)};
        const double change[2] = {changeTo(ahead), changeTo(behind)};
        forward =
            std::min(bend[0], bend[1]) < std::min(change[0], change[1]) ? bend[0] < bend[1] : change[0] < change[1];
    }
    const double other = forward ? ahead : behind;
    const double slope = 2.0 / (lens.size.at(axis) * std::abs(lens.scale.at(axis)));
    if (other <= 0.0 || std::abs(other - depth) > kSteepest * depth * slope) {
        return {};
    }
    const Vector way = minus(times(other, lens.ray(forward ? after : before)), times(depth, lens.ray(texel)));
    return forward ? way : times(-1.0, way);
}

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

std::optional<SolidContact> contactWith(const DepthField& field, const Vector& x) {
    const DepthHeader header = depthHeader(field);
    Vector eye{};
    Vector axes[3];
    for (std::size_t row = 0; row < 3; ++row) {
        const auto& r = header.rows.at(row);
        axes[row] = {double{r[0]}, double{r[1]}, double{r[2]}};
        eye.at(row) = dot(axes[row], x) + double{r[3]};
    }
    const double depth = -eye[2];
    if (field.depth.empty() || !(depth >= double{field.camera.near_plane})) {
        return std::nullopt;
    }
    const Lens lens{{double{header.lens[0]}, double{header.lens[1]}},
                    {double{header.lens[2]}, double{header.lens[3]}},
                    {double{header.limits[2]}, double{header.limits[3]}}};
    Texel texel{};
    for (std::size_t i = 0; i < 2; ++i) {
        const double pixel = ((lens.scale.at(i) * eye.at(i) / depth - lens.offset.at(i)) * 0.5 + 0.5) * lens.size.at(i);
        if (!(pixel >= 0.0 && pixel < lens.size.at(i))) {
            return std::nullopt;
        }
        texel.at(i) = static_cast<std::int64_t>(pixel);
    }
    const double surface = at(field, texel);
    if (surface <= 0.0) {
        return std::nullopt;
    }
    const Vector place = times(surface, lens.ray(texel));
    const Vector to_eye = times(-1.0, unit(place));
    const Vector across = tangent(field, lens, texel, 0, surface);
    const Vector up = tangent(field, lens, texel, 1, surface);
    const bool has_across = dot(across, across) > 0.0;
    const bool has_up = dot(up, up) > 0.0;
    Vector normal = to_eye;
    if (has_across && has_up) {
        normal = unit(cross(across, up));
        normal = times(dot(normal, to_eye) < 0.0 ? -1.0 : 1.0, normal);
    } else if (has_across || has_up) {
        const Vector along = unit(has_across ? across : up);
        normal = unit(minus(to_eye, times(dot(to_eye, along), along)));
    }
    const double facing = std::max(-dot(normal, eye) / depth, kLeastFacing);
    const double distance = dot(normal, minus(eye, place)) * std::max(1.0, kGrazing / facing);
    auto reach = double{field.thickness};
    for (std::size_t i = 0; i < 2; ++i) {
        reach = std::max(reach, surface * 2.0 / (lens.size.at(i) * std::abs(lens.scale.at(i))));
    }
    if (distance < -reach) {
        return std::nullopt;
    }
    Vector world{};
    for (std::size_t row = 0; row < 3; ++row) {
        world = plus(world, times(normal.at(row), axes[row]));
    }
    return SolidContact{world, distance};
}

}  // namespace sluice::vk
