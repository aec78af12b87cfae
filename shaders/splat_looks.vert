// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// splat.vert for particles of several looks: also the absorption of the particle's fluid.
#include "looks.glsl"
#include "vertex_sphere.glsl"

void main() {
    out_absorption = absorptionOf(placeSphere());
}
