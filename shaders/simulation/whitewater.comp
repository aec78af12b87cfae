// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Where water turns white (Ihmsen et al. 2012, section 3.1): how much air each particle traps, how much of a breaking crest it
// is, and how much energy it has, each from 0 to 1. docs/simulation.md has the formulas.
// Inputs:  the particles of the last step in sorted order with their lists, surface.comp's normals, velocities; behind them
//          those that were born at its end. Output: four floats for each place.
// Bound of its test: 1e-4 of each.
#include "places.glsl"
#include "simulation.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    vec2 air;     // m/s, summed over neighbours: from where it counts, and from where it is 1
    vec2 crest;   // summed curvature, likewise
    vec2 energy;  // m^2/s^2, likewise
    uint entries;
    uint moved;
    uint placed;  // 0: the place is the identity
} push;
layout(set = 0, binding = 1) uniform textureBuffer sorted;
layout(set = 0, binding = 2) uniform utextureBuffer list;
layout(set = 0, binding = 3) uniform textureBuffer surface;
layout(std430, set = 0, binding = 4) readonly buffer ListCount { uint list_count[]; };
layout(std430, set = 0, binding = 5) readonly buffer Positions { vec4 position[]; };
layout(std430, set = 0, binding = 6) readonly buffer Velocities { vec4 velocity[]; };
layout(std430, set = 0, binding = 7) readonly buffer Identities { uint identity[]; };
layout(std430, set = 0, binding = 8) writeonly buffer Potentials { vec4 potential[]; };
layout(std430, set = 0, binding = 9) readonly buffer Marks { uint marks[]; };
layout(std430, set = 0, binding = 10) readonly buffer Before { uint before[]; };

// Cosine between velocity and normal from which a crest breaks (the paper's).
const float FORWARD = 0.6;
// Lengths of surface.comp's normal between which a particle comes to count as surface: at a flat surface of a lattice the
// first layer has 0.95 and the second 0.02.
const vec2 AT_SURFACE = vec2(0.2, 0.6);

float part(float value, vec2 range) { return clamp((value - range.x) / (range.y - range.x), 0.0, 1.0); }

// Out of the fluid, unit; w: how much it is at the surface.
vec4 outward(uint i) {
    const vec3 inward = texelFetch(surface, int(i)).xyz;
    const float long_ = length(inward);
    return vec4(inward / -max(long_, 1e-6), smoothstep(AT_SURFACE.x, AT_SURFACE.y, long_));
}

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= push.entries || position[i].w != 0.0) {
        return;
    }
    const vec3 x = position[i].xyz;
    const vec3 v = velocity[i].xyz;
    const bool moved = i < push.moved;
    const uint number = moved ? list_count[i] : 0u;
    const vec4 n = moved ? outward(i) : vec4(0);
    float air = 0.0;
    float crest = 0.0;
    uint at = i;
    for (uint k = 0u; k < number; ++k, at += p.count.y) {
        const uint j = texelFetch(list, int(at)).x;
        const vec4 d = between(x, texelFetch(sorted, int(j)).xyz, i, j);
        const float weight = max(1.0 - d.w / p.high.w, 0.0);
        const vec3 apart = v - velocity[j].xyz;
        air += (length(apart) - dot(apart, d.xyz) / d.w) * weight;
        const vec4 other = outward(j);
        // Convex: the neighbour lies below the plane.
        crest += dot(d.xyz, n.xyz) > 0.0 ? (1.0 - dot(n.xyz, other.xyz)) * other.w * weight : 0.0;
    }
    const float speed = length(v);
    const bool forward = dot(v, n.xyz) >= FORWARD * speed && speed > 0.0;
    uint place = identity[i];
    if (push.placed != 0u) {
        place = placeOf(marks[place >> 5], before[place >> 5], place);
    }
    const vec3 parts = vec3(part(air, push.air), forward ? part(crest * n.w, push.crest) : 0.0,
                            part(0.5 * speed * speed, push.energy));
    potential[place] = vec4(parts, parts.z * min(parts.x + parts.y, 1.0));
}
