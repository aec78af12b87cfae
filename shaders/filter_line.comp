// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// One direction of the narrow-range filter.
// Inputs:  depth in metres, 1e30 = empty. Output: the same, filtered along x (ALONG = 0) or y (1); empty stays empty.
// A workgroup keeps LENGTH x ACROSS texels and as much on either side as its nearest pixel reaches; a workgroup without
// fluid stops after one look. The result depends on no order: the range is that of the unfiltered centre.
// Bound of its test: 3e-6 of the depth for the whole filter, but for one texel in 500 (samples on the very edge of the range).
#include "narrow_range.glsl"

layout(local_size_x_id = 1, local_size_y_id = 2) in;
layout(constant_id = 0) const uint ALONG = 0u;
layout(constant_id = 1) const uint SIZE_X = 64u;
layout(constant_id = 2) const uint SIZE_Y = 4u;

const int CAP = 128;  // kMaxFilterPixels
const int LENGTH = int(ALONG == 0u ? SIZE_X : SIZE_Y);
const int ACROSS = int(ALONG == 0u ? SIZE_Y : SIZE_X);

layout(set = 0, binding = 1) uniform texture2D depth_in;
layout(set = 0, binding = 2) writeonly uniform image2D depth_out;

// Sized for the larger of the two shapes, 64 x 4 and 8 x 32.
shared float tile[(32 + 2 * CAP) * 8];
shared uint nearest_bits;

float fetchDepth(ivec2 texel) {
    const bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(frame.size.xy)));
    return inside ? texelFetch(depth_in, texel, 0).r : EMPTY_DEPTH;
}

void main() {
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 local = ivec2(gl_LocalInvocationID.xy);
    const float depth = fetchDepth(texel);
    if (gl_LocalInvocationIndex == 0u) {
        nearest_bits = floatBitsToUint(EMPTY_DEPTH);
    }
    barrier();
    // Positive floats order as their bits do.
    if (!isEmpty(depth)) {
        atomicMin(nearest_bits, floatBitsToUint(depth));
    }
    barrier();
    const float nearest = uintBitsToFloat(nearest_bits);
    const bool inside = all(lessThan(texel, ivec2(frame.size.xy)));
    if (isEmpty(nearest)) {
        if (inside) {
            imageStore(depth_out, texel, vec4(EMPTY_DEPTH));
        }
        return;
    }

    const float focal = ALONG == 0u ? frame.focal.x : frame.focal.y;
    const int halo = halfWidth(sigmaPixels(nearest, focal));
    const int line = LENGTH + 2 * halo;
    const ivec2 corner = ivec2(gl_WorkGroupID.xy) * ivec2(SIZE_X, SIZE_Y);
    for (int index = int(gl_LocalInvocationIndex); index < line * ACROSS; index += LENGTH * ACROSS) {
        // Neighbouring threads take neighbouring texels of a row in either direction.
        const int along = ALONG == 0u ? index % line : index / ACROSS;
        const int across = ALONG == 0u ? index / line : index % ACROSS;
        const ivec2 offset = ALONG == 0u ? ivec2(along - halo, across) : ivec2(across, along - halo);
        const float d = fetchDepth(corner + offset);
        tile[across * line + along] = isEmpty(d) ? 0.0 : 1.0 / d;
    }
    barrier();
    if (!inside) {
        return;
    }
    if (isEmpty(depth)) {
        imageStore(depth_out, texel, vec4(EMPTY_DEPTH));
        return;
    }

    const int centre = (ALONG == 0u ? local.y : local.x) * line + (ALONG == 0u ? local.x : local.y) + halo;
    const Range range = rangeOf(depth);
    const float sigma = sigmaPixels(depth, focal);
    const int reach = halfWidth(sigma);
    // exp(-k^2 / 2 sigma^2) for k = 1, 2, ... by two multiplications: the ratio of neighbours is itself geometric.
    const float first = exp(-0.5 / (sigma * sigma));
    const float ratio_step = first * first;
    float ratio = first * ratio_step;
    float weight = first;
    float sum = tile[centre];
    float weights = 1.0;
    for (int k = 1; k <= reach; ++k) {
        addPair(range, tile[centre + k], tile[centre - k], weight, sum, weights);
        weight *= ratio;
        ratio *= ratio_step;
    }
    imageStore(depth_out, texel, vec4(weights / sum));
}
