// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Sorts the particles by cell, and within a cell by identity: the same order whatever the order of arrival was, so that
// every later sum has its terms in the same order too.
#define SEEN_BINDING 11
#include "seen.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 1) readonly buffer Arrival { uvec2 arrival[]; };
layout(std430, set = 0, binding = 2) readonly buffer Cells { uint cells[]; };
layout(std430, set = 0, binding = 3) readonly buffer Identity { uint identity[]; };
layout(std430, set = 0, binding = 4) readonly buffer Bucket { uint bucket[]; };
layout(std430, set = 0, binding = 5) readonly buffer Position { vec4 position[]; };
layout(std430, set = 0, binding = 6) readonly buffer Predicted { vec4 predicted[]; };
layout(std430, set = 0, binding = 7) writeonly buffer Sorted { vec4 sorted[]; };
layout(std430, set = 0, binding = 8) writeonly buffer Before { vec4 before[]; };
layout(std430, set = 0, binding = 9) writeonly buffer IdentityOut { uint identity_out[]; };
layout(std430, set = 0, binding = 10) buffer Status { uint faults, most_neighbours, speed, move; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= p.change.x || arrival[i].x == GONE) {
        return;
    }
    const uint cell = arrival[i].x;
    const uint first = cells[cell];
    uint last = cells[cell + 1u];
    if (last - first > MOST_CANDIDATES) {
        atomicOr(faults, FAULT_CROWDED);
        last = first + MOST_CANDIDATES;
    }
    const uint mine = identity[i];
    uint place = first;
    for (uint k = first; k < last; ++k) {
        place += bucket[k] < mine ? 1u : 0u;
    }
    const vec4 moved = predicted[i];
    sorted[place] = vec4(moved.xyz, FLUIDS == 1u ? p.kind[uint(moved.w)].a.y : 0.0);
    before[place] = vec4(SEEN == 1u ? rescuedFromSeen(position[i].xyz) : position[i].xyz, moved.w);
    identity_out[place] = mine;
}
