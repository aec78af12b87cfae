// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// splat_thickness.frag for ellipsoids. A stretch that keeps the volume keeps what a splat adds to the picture as a whole; a
// particle that is drawn smaller adds less.
// Inputs:  eye-space centre, what makes it a unit sphere, scene_depth.comp's image. Output: metres along the ray, R32F.
// Bound of its test: |error| <= 3e-2 splat radii (outlines, where a chord is a square root) + 1e-5 of the sum.
#include "ellipsoid.glsl"
#include "thickness.glsl"

layout(location = 0) flat in vec3 eye;
layout(location = 1) flat in vec3 first;
layout(location = 2) flat in vec3 second;
layout(location = 0) out float out_thickness;

void main() {
    const vec3 ray = rayThrough(gl_FragCoord.xy * frame.thickness.x);
    const float thickness = thicknessBetween(depthsInEllipsoid(ray, eye, symmetric(first, second)), ray);
    if (thickness <= 0.0) {
        discard;
    }
    out_thickness = thickness;
}
