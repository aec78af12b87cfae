// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// The velocity that took each particle to where it has been moved, m/s.
#include "simulation.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 1) readonly buffer Sorted { vec4 sorted[]; };
layout(std430, set = 0, binding = 2) readonly buffer Before { vec4 before[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Moving { vec4 moving[]; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i < p.count.x) {
        moving[i] = vec4((sorted[i].xyz - before[i].xyz) * p.fluid.w, before[i].w);
    }
}
