// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Moves each particle as its own lambda and its neighbours' ask (Macklin & Mueller 2013, eqs. 13 and 14), and out of the
// solids. What i does to j, j does to i: without walls the sum of all moves is zero to round-off.
#define BODIES_BINDING 6
#define MESH_BINDING 8
#define SEEN_BINDING 9
#include "solids.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 1) uniform textureBuffer pushed;
layout(set = 0, binding = 2) uniform utextureBuffer list;
layout(std430, set = 0, binding = 3) readonly buffer ListCount { uint list_count[]; };
layout(std430, set = 0, binding = 4) readonly buffer Walls { vec4 walls_of[]; };
layout(std430, set = 0, binding = 5) buffer Sorted { vec4 sorted[]; };
layout(std430, set = 0, binding = 10) readonly buffer Before { vec4 before[]; };  // read only if SEEN

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= p.count.x) {
        return;
    }
    const vec4 self = texelFetch(pushed, int(i));
    const float h = p.high.w;
    const float per_h = 1.0 / h;
    const uint number = list_count[i];
    vec3 delta = vec3(0);
    uint at = i;
    for (uint k = 0u; k < number; ++k, at += p.count.y) {
        const uint j = texelFetch(list, int(at)).x;
        const vec4 other = texelFetch(pushed, int(j));
        const vec4 d = between(self.xyz, other.xyz, i, j);
        const float near = max(h - d.w, 0.0);
        const float bracket = max(h * h - d.w * d.w, 0.0);
        const float q = d.w * per_h;
        float tensile = (KERNEL == POLY6 ? bracket * bracket * bracket : densityShape(q)) * p.fluid.z;
        tensile *= tensile;
        tensile *= tensile * p.kernel.w;
        const float push = self.w + other.w - tensile;
        if (KERNEL == POLY6) {
            delta += d.xyz * (push * p.kernel.y * near * near / d.w);
        } else {
            delta += d.xyz * (push * p.constraint.y * densityPull(q));
        }
    }
    const vec4 walls = walls_of[i];
    delta += self.w * walls.xyz;
    if (BODIES == 1u && self.w < 0.0) {  // of volumes: `heft` is still 1
        addPressure(self.xyz, walls.w, self.w);
    }
    float light = 0.0;
    if (FLUIDS == 1u) {
        light = sorted[i].w;
        heft = 1.0 / light;
        delta *= light;
    }
    sorted[i] = vec4(collided(self.xyz + delta, SEEN == 1u ? before[i].xyz : self.xyz), light);
}
