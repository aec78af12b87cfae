// SPDX-License-Identifier: MIT
// What bodies do to particles, and the sum of what particles do to them. Included by passes that move particles, after they
// have defined BODIES_BINDING; the sums are bound behind it. Mirrors BodyBlock and BodyPush of simulation/parameters.hpp.
#ifndef SLUICE_BODIES_GLSL
#define SLUICE_BODIES_GLSL
#include "simulation.glsl"

layout(constant_id = 1) const uint BODIES = 0u;
struct Body {
    vec4 centre;    // w = 1 / its reach
    vec4 velocity;  // m/s
    vec4 spin;      // rad/s
};
layout(std140, set = 0, binding = BODIES_BINDING) uniform Bodies { Body body[16]; } b;
layout(std430, set = 0, binding = BODIES_BINDING + 1) buffer Pushes { uint push_sum[]; };

// Whole numbers add up to the same whatever their order. 12 bits apart: the low part takes a million of them, each time
// that it wraps around the high part gets what it was worth.
void addWhole(uint at, float value) {
    const int whole = int(round(clamp(value, -67108864.0, 67108864.0)));
    const uint low = uint(whole & 0xfff);
    const uint before = atomicAdd(push_sum[at], low);
    atomicAdd(push_sum[at + 1u], uint(whole >> 12) + (before + low < before ? 1u << 20 : 0u));
}

// Of the particle that this invocation moves; set where FLUIDS.
float heft = 1.0;

// Body k has moved a particle at x by `push`, m.
void addPush(uint k, vec3 x, vec3 push) {
    vec3 parts = push * (4194304.0 / p.high.w);
    if (FLUIDS == 1u) {
        parts *= heft;
    }
    const vec3 moment = cross((x - b.body[k].centre.xyz) * b.body[k].centre.w, parts);
    const uint first = 12u * k;
    addWhole(first, parts.x);
    addWhole(first + 2u, parts.y);
    addWhole(first + 4u, parts.z);
    addWhole(first + 6u, moment.x);
    addWhole(first + 8u, moment.y);
    addWhole(first + 10u, moment.z);
}

vec3 bodyVelocity(uint k, vec3 x) { return b.body[k].velocity.xyz + cross(b.body[k].spin.xyz, x - b.body[k].centre.xyz); }

#endif
