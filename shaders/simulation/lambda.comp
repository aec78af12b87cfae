// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// How hard each particle pushes: the multiplier of its density constraint (Macklin & Mueller 2013, eq. 11). A density
// below that of rest pushes nobody: at a free surface it only means that there are too few particles to ask.
// Input: sorted positions, lists. Outputs: position with lambda (m^2, <= 0) in w; gradient and density of the walls.
#define MESH_BINDING 6
#include "solids.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint MEASURE = 0u;  // 1: w becomes the density instead, and nothing else is written
layout(set = 0, binding = 1) uniform textureBuffer sorted;
layout(set = 0, binding = 2) uniform utextureBuffer list;
layout(std430, set = 0, binding = 3) readonly buffer ListCount { uint list_count[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Pushed { vec4 pushed[]; };
layout(std430, set = 0, binding = 5) writeonly buffer Walls { vec4 walls_of[]; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= p.count.x) {
        return;
    }
    const vec4 self = texelFetch(sorted, int(i));
    const vec3 x = self.xyz;
    const float h = p.high.w;
    const uint number = list_count[i];
    const float per_h = 1.0 / h;
    float sum = KERNEL == POLY6 ? h * h * h * h * h * h : 1.0;
    float squares = 0.0;
    vec3 gradient = vec3(0);
    uint at = i;
    for (uint k = 0u; k < number; ++k, at += p.count.y) {
        const uint j = texelFetch(list, int(at)).x;
        const vec4 other = texelFetch(sorted, int(j));
        const vec4 d = between(x, other.xyz, i, j);
        float slope;
        float along;
        if (KERNEL == POLY6) {
            const float bracket = max(h * h - d.w * d.w, 0.0);
            sum += bracket * bracket * bracket;
            const float near = max(h - d.w, 0.0);
            slope = p.kernel.y * near * near;
            along = slope / d.w;
        } else {
            const float q = d.w * per_h;
            sum += densityShape(q);
            along = p.constraint.y * densityPull(q);
            slope = along * d.w;
        }
        if (FLUIDS == 1u) {
            squares += other.w * slope * slope;
        } else {
            squares += slope * slope;
        }
        gradient += d.xyz * along;
    }
    const vec4 walls = wallsAt(x);
    gradient += walls.xyz;
    const float density = (KERNEL == POLY6 ? p.kernel.x : p.constraint.x) * sum + walls.w;
    if (MEASURE == 1u) {
        pushed[i] = vec4(x, density);
        return;
    }
    float stiff = squares + dot(gradient, gradient) + p.kernel.z;
    if (FLUIDS == 1u) {  // who is lighter is moved farther by the same push
        stiff = squares + self.w * (dot(gradient, gradient) + p.kernel.z);
    }
    pushed[i] = vec4(x, -max(density - 1.0, 0.0) / stiff);
    walls_of[i] = walls;
}
