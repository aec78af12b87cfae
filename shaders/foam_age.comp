// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Foam that a particle carries: as white as it turns now, or what is left of what it was.
// Inputs:  who lives in the solver's order, whose they are, what turns white now (the last of four floats a place), what each
//          identity had at the value before. Outputs: both.
// Bound of its test: 1e-6.
#include "places.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint entries;
    uint placed;  // 0: the place is the identity
    float kept;   // of what was there
} push;
layout(std430, set = 0, binding = 0) readonly buffer Positions { vec4 position[]; };
layout(std430, set = 0, binding = 1) readonly buffer Identities { uint identity[]; };
layout(std430, set = 0, binding = 2) buffer Whitewater { vec4 whitewater[]; };
layout(std430, set = 0, binding = 3) buffer Foam { float foam[]; };
layout(std430, set = 0, binding = 4) readonly buffer Marks { uint marks[]; };
layout(std430, set = 0, binding = 5) readonly buffer Before { uint before[]; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= push.entries || position[i].w != 0.0) {
        return;
    }
    const uint who = identity[i];
    const uint place = push.placed != 0u ? placeOf(marks[who >> 5], before[who >> 5], who) : who;
    const float now = max(whitewater[place].w, foam[who] * push.kept);
    foam[who] = now;
    whitewater[place].w = now;
}
