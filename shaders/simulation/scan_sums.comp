// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// First of three passes that turn the particles of each cell into the cell's first place: the sum of each block of cells.
// Serial within a block and without barriers: see "why no pass uses shared memory" in docs/architecture.md.
#include "simulation.glsl"

layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 1) readonly buffer Cells { uint cells[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Sums { uint sums[]; };

const uint BLOCK = 512u;  // kScanBlock

void main() {
    const uint block = gl_GlobalInvocationID.x;
    const uint last = min((block + 1u) * BLOCK, p.grid.w);
    uint sum = 0u;
    for (uint i = block * BLOCK; i < last; ++i) {
        sum += cells[i];
    }
    if (block * BLOCK < p.grid.w) {
        sums[block] = sum;
    }
}
