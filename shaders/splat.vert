// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// A sphere as a point or a triangle around its exact perspective bounds; both splat passes use it.
// Inputs:  particle centres, world metres, three floats each. Vertices are pulled, not instanced: software rasterisers pay
//          for each instance what they would pay for a draw.
// Outputs: position in NDC (row 0 at the bottom, as OpenGL would put it), eye-space centre.
// Bound of its test: no pixel whose centre lies more than 0.01 pixels inside the sphere's outline is missed.
#include "vertex_sphere.glsl"

void main() {
    placeSphere();
}
