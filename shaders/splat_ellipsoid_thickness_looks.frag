// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// splat_thickness_looks.frag for ellipsoids.
// Bound of its test: that of splat_ellipsoid_thickness.frag times the largest absorption.
#include "ellipsoid.glsl"
#include "thickness.glsl"

layout(location = 0) flat in vec3 eye;
layout(location = 1) flat in vec3 first;
layout(location = 2) flat in vec3 second;
layout(location = 3) flat in vec3 absorption;
layout(location = 0) out float out_thickness;
layout(location = 1) out vec4 out_optical;

void main() {
    const vec3 ray = rayThrough(gl_FragCoord.xy * frame.thickness.x);
    const float thickness = thicknessBetween(depthsInEllipsoid(ray, eye, symmetric(first, second)), ray);
    if (thickness <= 0.0) {
        discard;
    }
    out_thickness = thickness;
    out_optical = vec4(absorption * thickness, 0.0);
}
