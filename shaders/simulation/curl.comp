// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// The curl of the velocity at each particle, 1/s, and its length in w (Macklin & Mueller 2013, eq. 15).
#include "simulation.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 1) uniform textureBuffer sorted;
layout(set = 0, binding = 2) uniform textureBuffer moving;
layout(set = 0, binding = 3) uniform utextureBuffer list;
layout(std430, set = 0, binding = 4) readonly buffer ListCount { uint list_count[]; };
layout(std430, set = 0, binding = 5) writeonly buffer Curl { vec4 curl_of[]; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= p.count.x) {
        return;
    }
    const vec3 x = texelFetch(sorted, int(i)).xyz;
    const vec3 v = texelFetch(moving, int(i)).xyz;
    const uint number = list_count[i];
    vec3 curl = vec3(0);
    uint at = i;
    for (uint k = 0u; k < number; ++k, at += p.count.y) {
        const uint j = texelFetch(list, int(at)).x;
        const vec4 d = between(x, texelFetch(sorted, int(j)).xyz, i, j);
        const float near = max(p.high.w - d.w, 0.0);
        // The gradient of the kernel with respect to j's place is minus that with respect to i's.
        curl += cross(texelFetch(moving, int(j)).xyz - v, d.xyz * (-p.kernel.y * near * near / d.w));
    }
    curl_of[i] = vec4(curl, length(curl));
}
