// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// splat_ellipsoid.vert for particles of several looks: also the absorption of the particle's fluid.
#include "looks.glsl"
#include "vertex_ellipsoid.glsl"

void main() {
    out_absorption = absorptionOf(placeEllipsoid());
}
