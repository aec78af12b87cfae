// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// How many particles the fullest column of cells along gravity's main axis holds: what the depth of the fluid is told from.
// Input: the first place of each cell. Columns that wrap around onto each other are counted together, so that the depth is
// never told too small.
#include "simulation.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint AXIS = 1u;
layout(std430, set = 0, binding = 1) readonly buffer Cells { uint cells[]; };
layout(std430, set = 0, binding = 2) buffer Status {
    uint faults, most_neighbours, speed, move, gone, stillborn, fullest;
};

void main() {
    const uvec3 size = uvec3(p.grid.x, p.grid.y + 1u, p.grid.z + 1u);
    const uint column = gl_GlobalInvocationID.x;
    const uint across = AXIS == 0u ? size.y : size.x;
    if (column >= across * (AXIS == 2u ? size.y : size.z)) {
        return;
    }
    const uint a = column % across;
    const uint b = column / across;
    uint number = 0u;
    if (AXIS == 0u) {  // a row of cells lies side by side
        const uint row = rowOf(int(a), int(b));
        number = cells[row + size.x] - cells[row];
    } else {
        for (uint c = 0u; c < (AXIS == 1u ? size.y : size.z); ++c) {
            const uint cell = (AXIS == 1u ? rowOf(int(c), int(b)) : rowOf(int(b), int(c))) + a;
            number += cells[cell + 1u] - cells[cell];
        }
    }
    if (number > fullest) {
        atomicMax(fullest, number);
    }
}
