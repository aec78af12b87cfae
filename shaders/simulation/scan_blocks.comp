// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Second of three: the first place of each block, by one invocation. At most kMostCells / kScanBlock = 8192 blocks.
#include "simulation.glsl"

layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 1) buffer Sums { uint sums[]; };

const uint BLOCK = 512u;  // kScanBlock

void main() {
    const uint blocks = (p.grid.w + BLOCK - 1u) / BLOCK;
    uint first = 0u;
    for (uint i = 0u; i < blocks; ++i) {
        const uint sum = sums[i];
        sums[i] = first;
        first += sum;
    }
}
