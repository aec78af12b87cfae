// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// How much fluid a sphere adds along the view ray; ADD blending sums the spheres.
// Inputs:  eye-space centre, scene_depth.comp's image. Output: metres along the ray, R32F, one texel per frame.thickness.x^2 pixels.
// The weight makes a lattice of spacing 2r add up to its own depth in metres. Only the part of the chord between the near
// plane and the scene counts.
// Bound of its test: |error| <= 2e-2 splat radii (outlines, where a chord is a square root) + 1e-5 of the sum.
#include "splat.glsl"

layout(set = 0, binding = 2) uniform texture2D scene_depth;

layout(location = 0) flat in vec3 eye;
layout(location = 0) out float out_thickness;

void main() {
    const float scale = frame.thickness.x;
    const vec3 ray = rayThrough(gl_FragCoord.xy * scale);
    const vec2 depths = depthsInSphere(ray, eye, splatRadius());
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
