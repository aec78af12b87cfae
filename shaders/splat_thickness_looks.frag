// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// splat_thickness.frag for several looks: beside the metres, the optical depth of what the sphere adds.
// Inputs:  eye-space centre, its fluid's absorption, scene_depth.comp's image. Outputs: metres, R32F, the bits of
//          splat_thickness.frag; their product with the absorption, RGBA32F, alpha unused.
// Bound of its test: that of splat_thickness.frag times the largest absorption.
#include "splat.glsl"
#include "thickness.glsl"

layout(location = 0) flat in vec3 eye;
layout(location = 3) flat in vec3 absorption;
layout(location = 0) out float out_thickness;
layout(location = 1) out vec4 out_optical;

void main() {
    const vec3 ray = rayThrough(gl_FragCoord.xy * frame.thickness.x);
    const float thickness = thicknessBetween(depthsInSphere(ray, eye, splatRadius()), ray);
    if (thickness <= 0.0) {
        discard;
    }
    out_thickness = thickness;
    out_optical = vec4(absorption * thickness, 0.0);
}
