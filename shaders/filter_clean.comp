// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// The narrow-range filter's last step: a small 2-D kernel that removes the streaks of the separable passes.
// Inputs:  depth in metres, 1e30 = empty. Output: the same, filtered.
// Bound of its test: see filter_line.comp.
#include "narrow_range.glsl"
#include "tiles.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 2) uniform texture2D depth_in;
layout(set = 0, binding = 3) writeonly uniform image2D depth_out;

const int RADIUS = 4;
// The streaks are a texel or two wide whatever the fluid's size on the screen; never wider than the main kernel, though.
const float CLEAN_SIGMA = float(RADIUS) / 3.0;

float depthAt(ivec2 texel) { return texelFetch(depth_in, texel, 0).r; }

void main() {
    const ivec2 texel = tileTexel();
    const ivec2 size = ivec2(frame.size.xy);
    if (any(greaterThanEqual(texel, size))) {
        return;
    }
    const float depth = texelFetch(depth_in, texel, 0).r;
    const Range range = rangeOf(depth);
    const float sigma = min(CLEAN_SIGMA, sigmaPixels(depth, min(frame.focal.x, frame.focal.y)));
    const int reach = isEmpty(depth) ? 0 : min(RADIUS, int(ceil(3.0 * sigma)));
    // A sample whose mirror image lies outside the picture does not count: the shorter side ends the loops.
    const ivec2 inside = min(ivec2(reach), min(texel, size - 1 - texel));
    const float falloff = -0.5 / (sigma * sigma);
    float sum = 1.0 / depth;
    float weights = 1.0;
    for (int x = 1; x <= inside.x; ++x) {
        addPair(range, depthAt(texel + ivec2(x, 0)), depthAt(texel - ivec2(x, 0)), exp(falloff * float(x * x)), sum,
                weights);
    }
    for (int y = 1; y <= inside.y; ++y) {
        addPair(range, depthAt(texel + ivec2(0, y)), depthAt(texel - ivec2(0, y)), exp(falloff * float(y * y)), sum,
                weights);
        for (int x = 1; x <= inside.x; ++x) {
            // Both diagonals' pairs in one step: a mirror only swaps them, and the sum stays the same to the bit.
            float values = 0.0;
            float count = 0.0;
            addPair(range, depthAt(texel + ivec2(x, y)), depthAt(texel - ivec2(x, y)), 1.0, values, count);
            addPair(range, depthAt(texel + ivec2(-x, y)), depthAt(texel - ivec2(-x, y)), 1.0, values, count);
            const float weight = exp(falloff * float(x * x + y * y));
            sum += weight * values;
            weights += weight * count;
        }
    }
    imageStore(depth_out, texel, vec4(isEmpty(depth) ? EMPTY_DEPTH : weights / sum));
}
