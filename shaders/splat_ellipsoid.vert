// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// An ellipsoid as a point or a triangle around its exact perspective bounds; both splat passes of frames with ellipsoids use it.
// Inputs:  nine floats each: centre, world metres; xx, xy, xz, yy, yz, zz of the symmetric stretch of a splat
//          (simulation/anisotropy.comp). Pulled, as in splat.vert.
// Outputs: position in NDC, eye-space centre, and the inverse of the stretch in eye space, 1/m: it makes a unit sphere of it.
// Bound of its test: no pixel whose centre lies more than 0.05 pixels inside the outline is missed.
#include "vertex_ellipsoid.glsl"

void main() {
    placeEllipsoid();
}
