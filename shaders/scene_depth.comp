// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// The farthest scene depth in each texel of thickness, once, for the many spheres that overlap there: of the depths in a
// texel the farthest, because the pixels that see that far need their whole thickness and the others are hidden anyway.
// Inputs:  HOST_DEPTH. Output: metres along -z, 1e30 = nothing; texels outside the listed tiles are left at 1e30.
// Bound of its test: that of splat_thickness.
#include "frame.glsl"
#include "tiles.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 2) uniform texture2D host_depth;
layout(set = 0, binding = 3) writeonly uniform image2D scene_out;

void main() {
    const ivec2 texel = tileTexel();
    if (any(greaterThanEqual(texel, imageSize(scene_out)))) {
        return;
    }
    const int scale = int(frame.thickness.x);
    const ivec2 first = texel * scale;
    const ivec2 last = min(first + scale, ivec2(frame.size.xy));
    float scene = 0.0;
    for (int y = first.y; y < last.y; ++y) {
        for (int x = first.x; x < last.x; ++x) {
            scene = max(scene, sceneDepth(texelFetch(host_depth, ivec2(x, y), 0).r));
        }
    }
    imageStore(scene_out, texel, vec4(scene));
}
