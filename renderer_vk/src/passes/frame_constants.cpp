// SPDX-License-Identifier: MIT
#include "passes/frame_constants.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>

namespace sluice::vk {
namespace {

Vec4 withLast(const float (&rgb)[3], float last = 0.0F) {
    return {rgb[0], rgb[1], rgb[2], last};
}

/// World direction to unit eye direction.
Vec4 eyeDirection(const float (&view)[16], const float (&direction)[3]) {
    Vec4 eye{};
    double squared = 0.0;
    for (std::size_t row = 0; row < 3; ++row) {
        eye[row] = view[row] * direction[0] + view[4 + row] * direction[1] + view[8 + row] * direction[2];
        squared += double{eye[row]} * double{eye[row]};
    }
    const double scale = squared > 0.0 ? 1.0 / std::sqrt(squared) : 0.0;
    for (std::size_t row = 0; row < 3; ++row) {
        eye[row] = static_cast<float>(double{eye[row]} * scale);
    }
    return eye;
}

}  // namespace

FrameConstants makeFrameConstants(const SluiceFrame& frame, const Plan& plan, const FrameTargets& targets,
                                  const ParticleBuffers& particles) {
    const SluiceFluid& fluid = frame.fluid;
    const float(&p)[16] = frame.camera.projection;
    const float radius = particles.radius;
    const auto width = static_cast<float>(plan.width);
    const auto height = static_cast<float>(plan.height);

    FrameConstants block{};
    for (std::size_t index = 0; index < block.view.size(); ++index) {
        block.view[index] = frame.camera.view[index];
    }
    // clip.w = s * depth; dividing the matrix by s leaves every NDC coordinate as it is.
    const float s = p[11] != 0.0F ? -p[11] : 1.0F;
    block.projection = {p[0] / s, p[5] / s, p[8] / s, p[9] / s};
    block.depth = {-p[10] / s, p[14] / s, frame.camera.near_plane, frame.camera.far_plane};
    block.size = {width, height, 1.0F / width, 1.0F / height};
    const float splat_radius = fluid.splat_radius * radius;
    block.focal = {std::abs(block.projection[0]) * width * 0.5F, std::abs(block.projection[1]) * height * 0.5F,
                   splat_radius, radius};
    block.absorption = withLast(fluid.absorption, fluid.index_of_refraction);
    block.scatter = withLast(fluid.scatter_colour, fluid.specular_power);
    block.zenith = withLast(frame.sky.zenith);
    block.horizon = withLast(frame.sky.horizon);
    block.ground = withLast(frame.sky.ground);
    block.to_sun = eyeDirection(frame.camera.view, frame.sky.to_sun);
    block.sun_radiance = withLast(frame.sky.sun_radiance);
    block.filter = {fluid.filter_range * radius, fluid.filter_clamp * radius, fluid.filter_sigma * radius,
                    static_cast<float>(fluid.filter_max_pixels)};
    // A particle of a lattice of spacing 2r stands for 8 r^3 of fluid; its chords integrate to 4/3 pi R^3.
    const double chord_weight =
        8.0 * std::pow(double{radius}, 3) / (4.0 / 3.0 * std::numbers::pi * std::pow(double{splat_radius}, 3));
    block.thickness = {std::round(1.0F / fluid.thickness_scale), fluid.thickness_blur * radius,
                       static_cast<float>(chord_weight), 0.0F};
    block.modes = {static_cast<std::uint32_t>(targets.host_depth_encoding), particles.count,
                   std::bit_cast<std::uint32_t>(plan.ellipsoids ? particles.longest : 1.0F),
                   std::bit_cast<std::uint32_t>(fluid.foam)};
    block.looks.fill(withLast(fluid.absorption));
    for (std::size_t i = 0; i < frame.other_look_count && i + 1 < block.looks.size(); ++i) {
        block.looks[i + 1] = withLast(frame.other_looks[i].absorption);
    }
    return block;
}

std::uint32_t looksApart(const SluiceFrame& frame) {
    const auto others = std::span(frame.other_looks).first(frame.other_look_count);
    const bool apart = std::any_of(others.begin(), others.end(), [&](const SluiceLook& look) {
        return !std::equal(std::begin(look.absorption), std::end(look.absorption), std::begin(frame.fluid.absorption));
    });
    return apart ? frame.other_look_count : 0;
}

float nearestPointDepth(const FrameConstants& block, float widest, float longest) {
    const double r = double{block.focal[2]} * double{longest};
    // Between the tangents at distance s = |(x, depth)| lie 2 r sqrt(s^2 - r^2) / (depth^2 - r^2) of slope (the
    // difference of the two bounds in shaders/common/splat.glsl); x is at most where the sphere still touches the
    // picture's edge.
    const auto pixels = [&](double depth, std::size_t axis) {
        const double edge =
            (1.0 + std::abs(double{block.projection[axis + 2]})) / std::abs(double{block.projection[axis]});
        const double x = edge * depth + r * std::sqrt(1.0 + edge * edge);
        return double{block.focal[axis]} * 2.0 * r * std::sqrt(depth * depth + x * x - r * r) / (depth * depth - r * r);
    };
    const auto fits = [&](double depth) {
        return pixels(depth, 0) <= double{widest} && pixels(depth, 1) <= double{widest};
    };
    double high = 2.0 * r;
    for (int doubling = 0; doubling < 64 && !fits(high); ++doubling) {
        high *= 2.0;
    }
    double low = r;
    for (int halving = 0; halving < 16; ++halving) {
        const double middle = 0.5 * (low + high);
        (fits(middle) ? high : low) = middle;
    }
    return fits(high) ? static_cast<float>(high * (1.0 + 1e-6)) : 1e30F;
}

}  // namespace sluice::vk
