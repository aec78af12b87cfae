// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Lists, for each particle, every other one nearer than the support, in sorted order.
// Bound of its test: equal to brute force but for pairs within 1e-5 of the support.
// Three neighbouring cells along x lie side by side, so that 27 cells are 9 walks. A list that is full goes on counting:
// the host then makes all lists longer and repeats the step.
#include "simulation.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 1) uniform textureBuffer sorted;
layout(set = 0, binding = 2) uniform utextureBuffer cells;
// As texels, of which a device takes more than bytes of a storage buffer: llvmpipe 512 MiB in place of 128.
layout(set = 0, binding = 3, r32ui) uniform writeonly uimageBuffer list;
layout(std430, set = 0, binding = 4) writeonly buffer ListCount { uint list_count[]; };
layout(std430, set = 0, binding = 5) buffer Status { uint faults, most_neighbours, speed, move; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= p.count.x) {
        return;
    }
    const vec3 x = texelFetch(sorted, int(i)).xyz;
    const float square = p.high.w * p.high.w;
    const ivec3 cell = cellOf(x);
    uint candidates = 0u;
    uint number = 0u;
    for (int row = 0; row < 9; ++row) {
        const uint first_cell = rowOf(cell.y + row % 3 - 1, cell.z + row / 3 - 1) + uint(cell.x) - 1u;
        const uint first = texelFetch(cells, int(first_cell)).x;
        uint last = texelFetch(cells, int(first_cell + 3u)).x;
        candidates += last - first;
        last = candidates > MOST_CANDIDATES ? first : last;
        for (uint j = first; j < last; ++j) {
            const vec3 d = texelFetch(sorted, int(j)).xyz - x;
            if (dot(d, d) < square && j != i) {
                if (number < p.count.z) {
                    imageStore(list, int(number * p.count.y + i), uvec4(j));
                }
                ++number;
            }
        }
    }
    list_count[i] = min(number, p.count.z);
    if (candidates > MOST_CANDIDATES) {
        atomicOr(faults, FAULT_CROWDED);
    }
    if (number > most_neighbours) {
        atomicMax(most_neighbours, number);
    }
}
