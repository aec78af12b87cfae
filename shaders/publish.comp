// SPDX-License-Identifier: MIT
#version 460
// The solver's particles, put into an output slot: packed as the splat passes read them, each in the place that it had
// when it was given, so that a particle keeps its place from frame to frame.
// Inputs:  position and velocity in the solver's order, and whose they are. Outputs: float triples, metres and m/s.
// Bound of its test: the same bits.
layout(local_size_x = 64) in;

layout(push_constant) uniform Push { uint count; } push;
layout(std430, set = 0, binding = 0) readonly buffer Positions { vec4 position[]; };
layout(std430, set = 0, binding = 1) readonly buffer Velocities { vec4 velocity[]; };
layout(std430, set = 0, binding = 2) readonly buffer Identities { uint identity[]; };
layout(std430, set = 0, binding = 3) writeonly buffer OutPositions { float out_position[]; };
layout(std430, set = 0, binding = 4) writeonly buffer OutVelocities { float out_velocity[]; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) {
        return;
    }
    const uint to = 3u * identity[i];
    const vec3 x = position[i].xyz;
    const vec3 v = velocity[i].xyz;
    out_position[to] = x.x;
    out_position[to + 1u] = x.y;
    out_position[to + 2u] = x.z;
    out_velocity[to] = v.x;
    out_velocity[to + 1u] = v.y;
    out_velocity[to + 2u] = v.z;
}
