// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Moves every particle by its velocity, gravity and force fields, keeps it out of the solids, and counts it into its cell.
// Inputs: position, velocity. Outputs: predicted position, cell and arrival of each particle, particles of each cell.
// The order of arrival is left to chance and forgotten in order.comp.
#define SOURCES_BINDING 7
#define BODIES_BINDING 8
#define MESH_BINDING 10
#define SEEN_BINDING 11
#include "solids.glsl"
#include "sources.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint FIELDS = 0u;
layout(std430, set = 0, binding = 1) readonly buffer Position { vec4 position[]; };
layout(std430, set = 0, binding = 2) readonly buffer Velocity { vec4 velocity[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Predicted { vec4 predicted[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Arrival { uvec2 arrival[]; };
layout(std430, set = 0, binding = 5) buffer Cells { uint cells[]; };
layout(std430, set = 0, binding = 6) buffer Status { uint faults, most_neighbours, speed, move; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= p.change.x) {
        return;
    }
    if (position[i].w != 0.0) {  // gone: it gets no place in the order
        arrival[i] = uvec2(GONE, 0u);
        return;
    }
    const float dt = p.gravity.w;
    const vec3 at = position[i].xyz;
    vec3 start = at;
    if (SEEN == 1u) {  // order.comp finds the same
        start = rescuedFromSeen(at);
        if (start != at) {  // the host's watch over the moves sees it too
            atomicMax(move, floatBitsToUint(length(start - at) + dt * length(velocity[i].xyz)));
        }
    }
    vec3 pull = p.gravity.xyz;
    if (FIELDS == 1u) {
        pull += fieldsAt(start);
    }
    const vec3 moved = start + dt * (velocity[i].xyz + dt * pull);
    if (isBad(moved)) {
        atomicOr(faults, FAULT_NOT_FINITE);
    }
    if (FLUIDS == 1u && BODIES == 1u) {
        heft = p.kind[uint(velocity[i].w)].a.x;
    }
    const vec3 x = collided(moved, start);
    predicted[i] = vec4(x, velocity[i].w);
    const ivec3 cell = cellOf(x);
    const uint index = rowOf(cell.y, cell.z) + uint(cell.x);
    arrival[i] = uvec2(index, atomicAdd(cells[index], 1u));
}
