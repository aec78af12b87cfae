// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// One direction of the narrow-range filter.
// Inputs:  depth in metres, 1e30 = empty. Output: the same, filtered along x (ALONG = 0) or y (1); empty stays empty.
// The result depends on no order: the range is that of the unfiltered centre.
// Bound of its test: 3e-6 of the depth for the whole filter, but for one texel in 500 (samples on the very edge of the range).
#include "narrow_range.glsl"
#include "tiles.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(constant_id = 0) const uint ALONG = 0u;

layout(set = 0, binding = 2) uniform texture2D depth_in;
layout(set = 0, binding = 3) writeonly uniform image2D depth_out;

void main() {
    const ivec2 texel = tileTexel();
    const ivec2 size = ivec2(frame.size.xy);
    if (any(greaterThanEqual(texel, size))) {
        return;
    }
    const float depth = texelFetch(depth_in, texel, 0).r;
    const float focal = ALONG == 0u ? frame.focal.x : frame.focal.y;
    const Range range = rangeOf(depth);
    const float sigma = sigmaPixels(depth, focal);
    // A sample whose mirror image lies outside the picture does not count: the shorter side ends the loop.
    const int here = ALONG == 0u ? texel.x : texel.y;
    const int limit = ALONG == 0u ? size.x : size.y;
    const int reach = isEmpty(depth) ? 0 : min(halfWidth(sigma), min(here, limit - 1 - here));
    // exp(-k^2 / 2 sigma^2) for k = 1, 2, ... by two multiplications: the ratio of neighbours is itself geometric.
    const float first = exp(-0.5 / (sigma * sigma));
    const float ratio_step = first * first;
    float ratio = first * ratio_step;
    float weight = first;
    float sum = 1.0 / depth;
    float weights = 1.0;
    for (int k = 1; k <= reach; ++k) {
        const ivec2 offset = ALONG == 0u ? ivec2(k, 0) : ivec2(0, k);
        const float a = texelFetch(depth_in, texel + offset, 0).r;
        const float b = texelFetch(depth_in, texel - offset, 0).r;
        addPair(range, a, b, weight, sum, weights);
        weight *= ratio;
        ratio *= ratio_step;
    }
    imageStore(depth_out, texel, vec4(isEmpty(depth) ? EMPTY_DEPTH : weights / sum));
}
