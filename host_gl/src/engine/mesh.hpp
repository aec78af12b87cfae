// SPDX-License-Identifier: MIT
// The building blocks, in immediate mode: call them while a display list is being compiled. World space, metres,
// counter-clockwise from outside. The vertex colour is a grey of baked ambient occlusion.
#pragma once

#include <span>

#include "sluice/host_gl/engine.hpp"

namespace sluice::host {

/// A rectangle on the ground: centre and half extents in x and z.
struct Plan {
    float x, z, half_x, half_z;
    [[nodiscard]] Plan grown(float by) const { return {x, z, half_x + by, half_z + by}; }
};

/// From foot to top, in metres.
struct Span {
    float low, high;
};

/// Periods of the texture per metre, and how dark the foot is (1 = not at all).
struct Skin {
    float u_per_metre, v_per_metre;
    float foot = 1.0F;
    float foot_height = 0.35F;  ///< metres over which the darkness fades
};

void emitSides(const Plan& plan, const Span& span, const Skin& skin);       ///< four walls seen from outside
void emitInnerSides(const Plan& plan, const Span& span, const Skin& skin);  ///< the same seen from inside
void emitTop(const Plan& plan, float y, float per_metre);
void emitUnderside(const Plan& plan, float y, float per_metre);
/// A flat frame between two rectangles of one centre, facing up.
void emitRing(const Plan& inner, const Plan& outer, float y, float per_metre);
void emitUnderRing(const Plan& inner, const Plan& outer, float y, float per_metre);
/// A horizontal grid facing up; the texture covers `metres` of it per period, from the world's origin.
void emitGround(const Plan& plan, float y, float metres, int cells);

/// One point of a turned profile: radius and height in metres, and the grey of its occlusion.
struct LathePoint {
    float radius, y, grey;
};
/// A surface of revolution about the vertical through (x, z); profile from the foot up, normals smooth along it.
void emitLathe(float x, float z, std::span<const LathePoint> profile, int segments, float u_turns, float v_per_metre);

/// A unit cube about the origin, the whole texture on every face.
void emitCube();

/// Soft dark border around (outside) or along the inner edge of (inside) a rectangle, textured with alphaFalloff.
void emitContactOutside(const Plan& plan, float y, float width);
void emitContactInside(const Plan& plan, float y, float width);

}  // namespace sluice::host
