// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// XSPH viscosity (Schechter & Bridson 2012), vorticity confinement, surface tension (Akinci et al. 2013), and the end of the step: the state that the next one
// starts from, with what the host judges it by.
#define BODIES_BINDING 10
#define MESH_BINDING 13
#define SEEN_BINDING 14
#include "solids.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint CONFINE = 0u;
layout(constant_id = 2) const uint TENSION = 0u;
layout(set = 0, binding = 1) uniform textureBuffer sorted;
layout(set = 0, binding = 2) uniform textureBuffer moving;
layout(set = 0, binding = 3) uniform textureBuffer curl_of;  // read only if CONFINE
layout(set = 0, binding = 4) uniform utextureBuffer list;
layout(std430, set = 0, binding = 5) readonly buffer ListCount { uint list_count[]; };
layout(std430, set = 0, binding = 6) readonly buffer Before { vec4 before[]; };
layout(std430, set = 0, binding = 7) writeonly buffer Position { vec4 position[]; };
layout(std430, set = 0, binding = 8) writeonly buffer Velocity { vec4 velocity[]; };
layout(set = 0, binding = 12) uniform textureBuffer surface;  // read only if TENSION
layout(std430, set = 0, binding = 9) buffer Status { uint faults, most_neighbours, speed, move; };

float pow3(float x) { return x * x * x; }

uint own = 0u;  // fluid of this particle

// Of a wall `d` away, m/s^2.
float attraction(float d) {
    const float at = clamp(d / p.high.w, 0.0, 1.0) * 16.0;
    const uint k = min(uint(at), 15u);
    const float strength = FLUIDS == 1u ? p.surface.z * p.kind[own].b.x : p.surface.z;
    return strength * mix(p.adhesion[k / 4u][k % 4u], p.adhesion[(k + 1u) / 4u][(k + 1u) % 4u], at - float(k));
}

// The cohesion kernel over its greatest value at h/2, 32 / (pi h^9) h^6 / 64 (Akinci et al. 2013, eq. 2). Attracts beyond about a
// quarter of the support, and repels within.
float cohesion(float q) {
    const float bump = 64.0 * pow3(1.0 - q) * pow3(q);
    return q > 0.5 ? bump : 2.0 * bump - 1.0;
}

// Towards walls, m/s^2; what pulls a particle to a body pulls the body to it.
vec3 adhesionAt(vec3 x) {
    const vec3 low = x - p.low.xyz;
    const vec3 high = p.high.xyz - x;
    vec3 pull = vec3(attraction(high.x) - attraction(low.x), attraction(high.y) - attraction(low.y),
                     attraction(high.z) - attraction(low.z));
    for (uint k = 0u; k < p.count.w; ++k) {
        const vec4 d = distanceTo(k, x);
        const vec3 to_solid = d.xyz * -attraction(d.w);
        pull += to_solid;
        if (BODIES == 1u && k >= p.change.w && d.w < p.high.w) {
            addPush(k - p.change.w, x, to_solid * (p.gravity.w * p.gravity.w));
        }
    }
    if (MESH == 1u) {
        const vec4 d = distanceToMesh(x);
        pull += d.xyz * -attraction(d.w);
    }
    if (SEEN == 1u) {
        const vec4 d = distanceToSeen(x);
        pull += d.xyz * -attraction(d.w);
    }
    return pull;
}

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= p.count.x) {
        return;
    }
    const vec3 x = texelFetch(sorted, int(i)).xyz;
    const vec3 v = texelFetch(moving, int(i)).xyz;
    const float h = p.high.w;
    const uint number = list_count[i];
    vec3 drift = vec3(0);
    vec3 eta = vec3(0);
    vec3 tension = vec3(0);
    vec4 mine_of = vec4(0);
    float rub = p.fluid.x;
    if (FLUIDS == 1u) {
        own = uint(before[i].w);
        mine_of = p.kind[own].a;
        rub = mine_of.z;
        heft = mine_of.x;
    }
    const vec4 mine = TENSION == 1u ? texelFetch(surface, int(i)) : vec4(0);
    uint at = i;
    for (uint k = 0u; k < number; ++k, at += p.count.y) {
        const uint j = texelFetch(list, int(at)).x;
        const vec4 d = between(x, texelFetch(sorted, int(j)).xyz, i, j);
        const float bracket = max(h * h - d.w * d.w, 0.0);
        const vec4 there = texelFetch(moving, int(j));
        // What one gives the other takes: of the mean, the lighter gets more.
        float share = 1.0;
        float pull = 1.0;
        if (FLUIDS == 1u) {
            const vec4 theirs = p.kind[uint(there.w)].a;
            share = 2.0 * mine_of.y / (mine_of.y + theirs.y);
            pull = share * sqrt(mine_of.w * theirs.w);
            share *= 0.5 * (mine_of.z + theirs.z);
            drift += (there.xyz - v) * (bracket * bracket * bracket * share);
        } else {
            drift += (there.xyz - v) * (bracket * bracket * bracket);
        }
        if (TENSION == 1u) {
            const vec4 other = texelFetch(surface, int(j));
            const vec3 force = (d.xyz * (p.surface.x * cohesion(d.w / h) / d.w) + (mine.xyz - other.xyz) * p.surface.y) *
                               (2.0 / (mine.w + other.w));
            if (FLUIDS == 1u) {
                tension -= force * pull;
            } else {
                tension -= force;
            }
        }
        if (CONFINE == 1u) {
            const float near = max(h - d.w, 0.0);
            eta += d.xyz * (texelFetch(curl_of, int(j)).w * p.kernel.y * near * near / d.w);
        }
    }
    vec3 result = v + (FLUIDS == 1u ? p.kernel.x * drift : p.fluid.x * p.kernel.x * drift);
    if (BODIES == 1u) {  // the fluid at rest that stands for the body moves with it
        for (uint k = p.change.w; k < p.count.w; ++k) {
            const float q = max(distanceTo(k, x).w, 0.0) / h;
            if (q < 1.0) {
                const uint body = k - p.change.w;
                const vec3 drag = (bodyVelocity(body, x) - v) * (rub * wallShare(q));
                addPush(body, x, drag * p.gravity.w);
                result += drag;
            }
        }
    }
    if (CONFINE == 1u) {
        const float steep = length(eta);
        const vec3 curl = texelFetch(curl_of, int(i)).xyz;
        result += p.gravity.w * p.fluid.y * (steep > 1e-6 ? cross(eta / steep, curl) : vec3(0));
    }
    if (TENSION == 1u) {
        result += p.gravity.w * tension;
        if (p.surface.w == 1.0) {
            result += p.gravity.w * adhesionAt(x);
        }
    }
    position[i] = vec4(x, 0);
    velocity[i] = vec4(result, before[i].w);
    if (isBad(x) || isBad(result)) {
        atomicOr(faults, FAULT_NOT_FINITE);
    }
    // Floats that are not negative are ordered as their bits are.
    const uint faster = floatBitsToUint(length(result));
    const uint farther = floatBitsToUint(length(x - before[i].xyz));
    if (faster > speed) {
        atomicMax(speed, faster);
    }
    if (farther > move) {
        atomicMax(move, farther);
    }
}
