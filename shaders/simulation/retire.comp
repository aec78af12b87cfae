// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// After a step: marks the particles that lie in a drain as gone, and the births that a particle is in the way of as never
// happened. Both marks are set by whoever finds a reason, so that it does not matter who comes first.
#define SOURCES_BINDING 1
#include "simulation.glsl"
#include "sources.glsl"

layout(local_size_x = 64) in;
struct Birth {
    vec4 position, velocity;
};
layout(std430, set = 0, binding = 2) readonly buffer Births { Birth births[]; };
layout(std430, set = 0, binding = 3) buffer Blocked { uint blocked[]; };
layout(std430, set = 0, binding = 4) buffer Position { vec4 position[]; };
layout(std430, set = 0, binding = 5) buffer Status { uint faults, most_neighbours, speed, move, gone, stillborn; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= p.count.x) {
        return;
    }
    const vec3 x = position[i].xyz;
    if (drained(x)) {
        position[i].w = 1.0;
        atomicAdd(gone, 1u);
        return;
    }
    // Four fifths of the distance at rest: a jet that is slowed down a little goes on, one that is stopped does not.
    const float apart = 1.6 * p.low.w;
    for (uint e = 0u; e < s.number.z; ++e) {
        const vec4 around = s.outlet[e].around;
        const vec3 away = x - around.xyz;
        if (dot(away, away) >= around.w * around.w) {
            continue;
        }
        for (uint k = s.outlet[e].births.x; k < s.outlet[e].births.y; ++k) {
            const vec3 d = x - births[k].position.xyz;
            if (dot(d, d) < apart * apart) {
                atomicOr(blocked[k], 1u);
            }
        }
    }
}
