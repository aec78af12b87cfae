// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// A sphere as a point or a triangle around its exact perspective bounds; both splat passes use it.
// Inputs:  particle centres, world metres, three floats each. Vertices are pulled, not instanced: software rasterisers pay
//          for each instance what they would pay for a draw.
// Outputs: position in NDC (row 0 at the bottom, as OpenGL would put it), eye-space centre.
// Bound of its test: no pixel whose centre lies more than 0.01 pixels inside the sphere's outline is missed.
#include "place_splat.glsl"

layout(std430, set = 0, binding = 1) readonly buffer Positions { float position[]; };

layout(location = 0) flat out vec3 out_eye;

void main() {
    const uint particle = uint(gl_VertexIndex) / VERTICES;
    const uint corner = uint(gl_VertexIndex) - particle * VERTICES;
    const vec3 world = vec3(position[3u * particle], position[3u * particle + 1u], position[3u * particle + 2u]);
    const vec3 eye = (frame.view * vec4(world, 1.0)).xyz;
    out_eye = eye;
    placeSplat(ndcBounds(eye, splatRadius()), eye, isNear(depthOf(world)), corner);
}
