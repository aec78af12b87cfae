// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Puts the births behind the particles of the step. Those whose place is taken are born gone: they use up their number, so
// that who is born later does not depend on them, and leave at the next sort.
#include "simulation.glsl"

layout(local_size_x = 64) in;
struct Birth {
    vec4 position, velocity;
};
layout(std430, set = 0, binding = 1) readonly buffer Births { Birth births[]; };
layout(std430, set = 0, binding = 2) readonly buffer Blocked { uint blocked[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Position { vec4 position[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Velocity { vec4 velocity[]; };
layout(std430, set = 0, binding = 5) writeonly buffer Identity { uint identity[]; };
layout(std430, set = 0, binding = 6) buffer Status { uint faults, most_neighbours, speed, move, gone, stillborn; };

void main() {
    const uint k = gl_GlobalInvocationID.x;
    if (k >= p.change.y) {
        return;
    }
    const uint i = p.count.x + k;
    const bool taken = blocked[k] != 0u;
    position[i] = vec4(births[k].position.xyz, taken ? 1.0 : 0.0);
    velocity[i] = births[k].velocity;
    identity[i] = p.change.z + k;
    if (taken) {
        atomicAdd(stillborn, 1u);
    }
}
