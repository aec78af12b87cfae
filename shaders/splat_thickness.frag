// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// How much fluid a sphere adds along the view ray; ADD blending sums the spheres.
// Inputs:  eye-space centre, scene_depth.comp's image. Output: metres along the ray, R32F, one texel per frame.thickness.x^2 pixels.
// Bound of its test: |error| <= 2e-2 splat radii (outlines, where a chord is a square root) + 1e-5 of the sum.
#include "splat.glsl"
#include "thickness.glsl"

layout(location = 0) flat in vec3 eye;
layout(location = 0) out float out_thickness;

void main() {
    const vec3 ray = rayThrough(gl_FragCoord.xy * frame.thickness.x);
    const float thickness = thicknessBetween(depthsInSphere(ray, eye, splatRadius()), ray);
    if (thickness <= 0.0) {
        discard;
    }
    out_thickness = thickness;
}
