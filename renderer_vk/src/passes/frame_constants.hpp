// SPDX-License-Identifier: MIT
// The uniform block that every pass of a frame reads; shaders/common/frame.glsl is its mirror (std140).
#pragma once

#include <array>
#include <cstdint>

#include "frame/pass_context.hpp"
#include "plan/plan.hpp"
#include "sluice/plugin.h"

namespace sluice::vk {

using Vec4 = std::array<float, 4>;

/// Lengths are metres unless a name says pixels; colours are linear.
struct FrameConstants {
    std::array<float, 16> view;  ///< world to eye, column-major
    Vec4 projection;  ///< x and y scale, x and y offset: ndc = scale * slope - offset, slope = eye.xy / depth
    Vec4 depth;       ///< ndc z = a + b / depth: a, b; near plane, far plane
    Vec4 size;        ///< width, height, 1 / width, 1 / height in pixels
    Vec4 focal;       ///< pixels per unit slope in x and y; splat radius, particle radius
    Vec4 absorption;  ///< per metre; w = index of refraction
    Vec4 scatter;     ///< w = specular power
    Vec4 zenith, horizon, ground;  ///< of the procedural sky
    Vec4 to_sun;                   ///< unit, eye space
    Vec4 sun_radiance;
    Vec4 filter;     ///< delta, mu, sigma; w = cap in pixels
    Vec4 thickness;  ///< pixels per thickness texel; sigma of the blur; chord weight; depth below which no point is
                     ///< wide enough
    std::array<std::uint32_t, 4>
        modes;  ///< SluiceDepthEncoding of HOST_DEPTH, particles, bits of the longest axis and of foam
    std::array<Vec4, SLUICE_MAX_FLUIDS> looks;  ///< absorption of each fluid
};
static_assert(sizeof(FrameConstants) == 64 + 14 * 16 + 16 * SLUICE_MAX_FLUIDS, "std140 has no padding here");

/// How many of the other looks there are to tell apart: 0 where all are that of the first fluid.
[[nodiscard]] std::uint32_t looksApart(const SluiceFrame& frame);

/// The depth from which on every splat that touches the picture has a rectangle of at most `widest` pixels each way. It
/// lies within `longest` splat radii of its centre.
[[nodiscard]] float nearestPointDepth(const FrameConstants& block, float widest, float longest);

/// Derives the block, but for nearestPointDepth, which depends on the device. The projection may be off-centre; its
/// fourth row must be (0, 0, -s, 0) with s > 0.
[[nodiscard]] FrameConstants makeFrameConstants(const SluiceFrame& frame, const Plan& plan, const FrameTargets& targets,
                                                const ParticleBuffers& particles);

}  // namespace sluice::vk
