// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// How much foam a sphere adds along the view ray; ADD blending sums the spheres.
// Inputs:  eye-space centre, foam of the particle (0 to 1), scene_depth.comp's image, the fluid's final depth. Output: metres
//          along the ray, R32F, one texel per frame.thickness.x^2 pixels.
// What splat_thickness.frag adds, times the foam, times what the water in front of it lets through: foam lies on the
// surface, and what is white far below it is bubbles.
// Bound of its test: that of splat_thickness.frag.
#include "splat.glsl"

layout(set = 0, binding = 2) uniform texture2D scene_depth;
layout(set = 0, binding = 3) uniform texture2D surface;

layout(location = 0) flat in vec3 eye;
layout(location = 1) flat in float foam;
layout(location = 0) out float out_foam;

// Particle radii of water after which 1/e of the foam behind them is seen.
const float SEEN = 6.0;

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
    const ivec2 pixel = min(ivec2(gl_FragCoord.xy * scale), ivec2(frame.size.xy) - 1);
    const float front = texelFetch(surface, pixel, 0).r;
    const float middle = 0.5 * (depths.x + depths.y);
    const float below = isEmpty(front) ? 0.0 : max(middle - front, 0.0);
    out_foam = frame.thickness.z * chord * length(ray) * foam * exp(-below * length(ray) / (SEEN * particleRadius()));
}
