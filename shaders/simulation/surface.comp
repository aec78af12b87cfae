// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// What surface tension asks of each particle: h times the gradient of the density's colour field, which is the inward normal
// of the surface and about zero within, and the density (Akinci et al. 2013). Fluid at rest stands for walls, so that a wall
// is no surface.
#define MESH_BINDING 5
#include "solids.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 1) uniform textureBuffer sorted;
layout(set = 0, binding = 2) uniform utextureBuffer list;
layout(std430, set = 0, binding = 3) readonly buffer ListCount { uint list_count[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Surface { vec4 surface[]; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= p.count.x) {
        return;
    }
    const vec3 x = texelFetch(sorted, int(i)).xyz;
    const float h = p.high.w;
    const uint number = list_count[i];
    float sum = h * h * h * h * h * h;
    vec3 gradient = vec3(0);
    uint at = i;
    for (uint k = 0u; k < number; ++k, at += p.count.y) {
        const uint j = texelFetch(list, int(at)).x;
        const vec4 d = between(x, texelFetch(sorted, int(j)).xyz, i, j);
        const float bracket = max(h * h - d.w * d.w, 0.0);
        sum += bracket * bracket * bracket;
        const float near = max(h - d.w, 0.0);
        gradient += d.xyz * (p.kernel.y * near * near / d.w);
    }
    const vec4 walls = wallsAt(x);
    surface[i] = vec4(h * (gradient + walls.xyz), p.kernel.x * sum + walls.w);
}
