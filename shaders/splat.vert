// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// A sphere as a point or a triangle around its exact perspective bounds; both splat passes use it.
// Inputs:  particle centres, world metres, three floats each. Vertices are pulled, not instanced: software rasterisers pay
//          for each instance what they would pay for a draw.
// Outputs: position in NDC (row 0 at the bottom, as OpenGL would put it), eye-space centre.
// VERTICES = 1: a point, the square around the rectangle: one vertex, and no setup of edges. 3: one triangle around the
// rectangle, for the spheres whose rectangle may be wider than the widest point.
// Bound of its test: no pixel whose centre lies more than 0.01 pixels inside the sphere's outline is missed.
#include "splat.glsl"

layout(constant_id = 0) const uint VERTICES = 1u;
layout(constant_id = 1) const uint SCALED = 0u;  // 1: the target has frame.thickness.x pixels per texel

layout(std430, set = 0, binding = 1) readonly buffer Positions { float position[]; };

layout(location = 0) flat out vec3 out_eye;

void main() {
    const uint particle = uint(gl_VertexIndex) / VERTICES;
    const uint corner = uint(gl_VertexIndex) - particle * VERTICES;
    const vec3 world = vec3(position[3u * particle], position[3u * particle + 1u], position[3u * particle + 2u]);
    const vec3 eye = (frame.view * vec4(world, 1.0)).xyz;
    out_eye = eye;

    const float scale = SCALED != 0u ? frame.thickness.x : 1.0;
    // The target may reach beyond the picture by less than a texel, whose centre can lie on the picture's very edge.
    const vec2 target = ceil(frame.size.xy / scale);
    const vec2 beyond = 2.0 * target * scale * frame.size.zw - 1.0;
    vec4 bounds = ndcBounds(eye, splatRadius());
    bounds = vec4(max(bounds.xy, vec2(-1.0)), min(bounds.zw, beyond));
    // Texel centres inside the bounds; a sphere between them costs no triangle.
    const vec4 texels = (bounds * 0.5 + 0.5) * frame.size.xyxy / scale;
    const bool touches = all(lessThanEqual(ceil(texels.xy - 0.5), floor(texels.zw - 0.5)));
    const bool other = isNear(depthOf(world)) != (VERTICES == 3u);
    // Negated so that a NaN position is dropped, too.
    gl_PointSize = 1.0;
    if (other || !touches || !all(lessThan(abs(eye), vec3(1e15)))) {
        gl_Position = vec4(-2.0, -2.0, 0.5, 1.0);
        return;
    }
    if (VERTICES == 1u) {
        // A point's position and size may be rounded to 1/16 of a pixel on a device and to 1/256 on llvmpipe.
        const vec2 extent = texels.zw - texels.xy;
        gl_Position = vec4((texels.xy + texels.zw) / target - 1.0, 0.5, 1.0);
        gl_PointSize = max(extent.x, extent.y) + 0.125;
        return;
    }
    const vec2 along = vec2(corner == 1u ? 2.0 : 0.0, corner == 2u ? 2.0 : 0.0);
    const vec2 texel = texels.xy + along * (texels.zw - texels.xy);
    gl_Position = vec4(2.0 * texel / target - 1.0, 0.5, 1.0);
}
