// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Is any sphere too near to be drawn as a point? Then, and only then, both splats also draw triangles.
// Inputs:  particle centres, world metres, three floats each. How many: the draw of points says it.
// Output: the vertices of an indirect draw: 0 or three each.
// Bound of its test: that of the splats; a sphere that it missed would leave a hole.
#include "splat.glsl"

layout(local_size_x = 256) in;

layout(std430, set = 0, binding = 1) readonly buffer Positions { float position[]; };
layout(std430, set = 0, binding = 2) buffer Draws { uvec4 triangles, points; } draw;

void main() {
    const uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 256u + gl_LocalInvocationID.x;
    const uint count = draw.points.x;
    if (index >= count) {
        return;
    }
    const float depth = depthOf(vec3(position[3u * index], position[3u * index + 1u], position[3u * index + 2u]));
    // What is wholly behind the near plane is not drawn at all.
    if (isNear(depth) && depth + splatRadius() > nearPlane()) {
        atomicMax(draw.triangles.x, 3u * count);
    }
}
