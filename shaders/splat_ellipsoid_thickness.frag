// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// splat_thickness.frag for ellipsoids. A stretch that keeps the volume keeps what a splat adds to the picture as a whole; a
// particle that is drawn smaller adds less.
// Inputs:  eye-space centre, what makes it a unit sphere, scene_depth.comp's image. Output: metres along the ray, R32F.
// Bound of its test: |error| <= 3e-2 splat radii (outlines, where a chord is a square root) + 1e-5 of the sum.
#include "ellipsoid.glsl"

layout(set = 0, binding = 2) uniform texture2D scene_depth;

layout(location = 0) flat in vec3 eye;
layout(location = 1) flat in vec3 first;
layout(location = 2) flat in vec3 second;
layout(location = 0) out float out_thickness;

void main() {
    const vec3 ray = rayThrough(gl_FragCoord.xy * frame.thickness.x);
    const vec2 depths = depthsInEllipsoid(ray, eye, symmetric(first, second));
    if (depths.x > depths.y) {
        discard;
    }
    const float scene = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    const float chord = min(depths.y, scene) - max(depths.x, nearPlane());
    if (chord <= 0.0) {
        discard;
    }
    out_thickness = frame.thickness.z * chord * length(ray);
}
