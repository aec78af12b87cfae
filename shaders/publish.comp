// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// The solver's particles, put into an output slot: packed as the splat passes read them, in the order in which they were
// given or born, without those that are gone.
// Inputs:  position and velocity in the solver's order, whose they are, and places.comp's count where somebody comes or
//          goes. Outputs: float triples, metres and m/s; of several fluids, which each is of.
// Bound of its test: the same bits.
#include "places.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
    uint count;
    uint changing;  // 0: everybody lives, and marks and before are nothing
    uint several;   // 0: one fluid, and out_fluid is nothing
} push;
layout(std430, set = 0, binding = 0) readonly buffer Positions { vec4 position[]; };
layout(std430, set = 0, binding = 1) readonly buffer Velocities { vec4 velocity[]; };
layout(std430, set = 0, binding = 2) readonly buffer Identities { uint identity[]; };
layout(std430, set = 0, binding = 3) writeonly buffer OutPositions { float out_position[]; };
layout(std430, set = 0, binding = 4) writeonly buffer OutVelocities { float out_velocity[]; };
layout(std430, set = 0, binding = 5) readonly buffer Marks { uint marks[]; };
layout(std430, set = 0, binding = 6) readonly buffer Before { uint before[]; };
layout(std430, set = 0, binding = 7) writeonly buffer OutFluids { uint out_fluid[]; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) {
        return;
    }
    uint place = identity[i];
    if (push.changing != 0u) {
        const uint word = place >> 5;
        if (!lives(marks[word], place)) {
            return;
        }
        place = placeOf(marks[word], before[word], place);
    }
    const uint to = 3u * place;
    const vec3 x = position[i].xyz;
    const vec3 v = velocity[i].xyz;
    out_position[to] = x.x;
    out_position[to + 1u] = x.y;
    out_position[to + 2u] = x.z;
    out_velocity[to] = v.x;
    out_velocity[to + 1u] = v.y;
    out_velocity[to + 2u] = v.z;
    if (push.several != 0u) {
        out_fluid[place] = uint(velocity[i].w);
    }
}
