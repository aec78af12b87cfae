// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the particles of each cell, in order of arrival.
#include "simulation.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 1) readonly buffer Arrival { uvec2 arrival[]; };
layout(std430, set = 0, binding = 2) readonly buffer Cells { uint cells[]; };
layout(std430, set = 0, binding = 3) readonly buffer Identity { uint identity[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Bucket { uint bucket[]; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i < p.change.x && arrival[i].x != GONE) {
        bucket[cells[arrival[i].x] + arrival[i].y] = identity[i];
    }
}
