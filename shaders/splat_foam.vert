// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// splat.vert for what a simulation's particles have of foam: who has none costs no fragment.
// Inputs:  particle centres, world metres, three floats each; four floats of whitewater each, the last its foam, 0 to 1.
// Outputs: as splat.vert; the foam.
// Bound of its test: splat.vert's.
#include "place_splat.glsl"

layout(std430, set = 0, binding = 1) readonly buffer Positions { float position[]; };
layout(std430, set = 0, binding = 4) readonly buffer Whitewater { vec4 whitewater[]; };

layout(location = 0) flat out vec3 out_eye;
layout(location = 1) flat out float out_foam;

void main() {
    const uint particle = uint(gl_VertexIndex) / VERTICES;
    const uint corner = uint(gl_VertexIndex) - particle * VERTICES;
    const vec3 world = vec3(position[3u * particle], position[3u * particle + 1u], position[3u * particle + 2u]);
    const vec3 eye = (frame.view * vec4(world, 1.0)).xyz;
    out_eye = eye;
    out_foam = whitewater[particle].w;
    placeSplat(ndcBounds(eye, splatRadius()), eye, isNear(depthOf(world)), corner);
    if (!(out_foam > 0.0)) {
        gl_Position = vec4(-2.0, -2.0, 0.5, 1.0);
    }
}
