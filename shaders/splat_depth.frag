// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// The depth at which the view ray enters a sphere; MIN blending keeps the nearest of all spheres, in any order.
// Inputs:  eye-space centre. Output: metres along -z, R32F.
// A sphere that the near plane cuts shows its cut at the near plane, so that nothing pops when the eye goes in.
// Bound of its test: |depth error| <= 2e-3 splat radii + 4e-6 of the depth, at pixels more than 0.05 pixels inside.
#include "splat.glsl"

layout(location = 0) flat in vec3 eye;
layout(location = 0) out float out_depth;

void main() {
    const vec2 depths = depthsInSphere(rayThrough(gl_FragCoord.xy), eye, splatRadius());
    const float depth = max(depths.x, nearPlane());
    if (depth > depths.y || depth > farPlane()) {
        discard;
    }
    out_depth = depth;
}
