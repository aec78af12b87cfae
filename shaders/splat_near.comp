// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Is any splat too near to be drawn as a point? Then, and only then, both splats also draw triangles.
// Inputs:  particle centres, world metres, the first three of FLOATS floats each. How many: the draw of points says it.
// Output: the vertices of an indirect draw: 0 or three each.
// Bound of its test: that of the splats; a sphere that it missed would leave a hole.
#include "splat.glsl"

layout(local_size_x = 256) in;
layout(constant_id = 0) const uint FLOATS = 3u;  // 9: ellipsoids

layout(std430, set = 0, binding = 1) readonly buffer Positions { float position[]; };
layout(std430, set = 0, binding = 2) buffer Draws { uvec4 triangles, points; } draw;

void main() {
    const uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 256u + gl_LocalInvocationID.x;
    const uint count = draw.points.x;
    if (index >= count) {
        return;
    }
    const uint at = FLOATS * index;
    const float depth = depthOf(vec3(position[at], position[at + 1u], position[at + 2u]));
    // What is wholly behind the near plane is not drawn at all.
    if (isNear(depth) && depth + splatReach() > nearPlane()) {
        atomicMax(draw.triangles.x, 3u * count);
    }
}
