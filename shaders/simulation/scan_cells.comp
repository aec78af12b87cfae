// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Third of three: the first place of each cell in the place of its number; one place more at the end holds the total.
#include "simulation.glsl"

layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 1) buffer Cells { uint cells[]; };
layout(std430, set = 0, binding = 2) readonly buffer Sums { uint sums[]; };

const uint BLOCK = 512u;  // kScanBlock

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block * BLOCK >= p.grid.w) {
        return;
    }
    const uint last = min((block + 1u) * BLOCK, p.grid.w);
    uint first = sums[block];
    for (uint i = block * BLOCK; i < last; ++i) {
        const uint number = cells[i];
        cells[i] = first;
        first += number;
    }
    if (last == p.grid.w) {
        cells[last] = first;
    }
}
