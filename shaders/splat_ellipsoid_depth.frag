// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// splat_depth.frag for ellipsoids: the depth at which the view ray enters.
// Inputs:  eye-space centre, what makes it a unit sphere. Output: metres along -z, R32F.
// Bound of its test: |depth error| <= 3e-3 splat radii + 4e-6 of the depth, at pixels more than 0.05 pixels inside.
#include "ellipsoid.glsl"

layout(location = 0) flat in vec3 eye;
layout(location = 1) flat in vec3 first;
layout(location = 2) flat in vec3 second;
layout(location = 0) out float out_depth;

void main() {
    const vec2 depths = depthsInEllipsoid(rayThrough(gl_FragCoord.xy), eye, symmetric(first, second));
    const float depth = max(depths.x, nearPlane());
    if (depth > depths.y || depth > farPlane()) {
        discard;
    }
    out_depth = depth;
}
