// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// The narrow-range filter's last step: a small 2-D kernel that removes the streaks of the separable passes.
// Inputs:  depth in metres, 1e30 = empty. Output: the same, filtered.
// Bound of its test: see filter_line.comp.
#include "narrow_range.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 1) uniform texture2D depth_in;
layout(set = 0, binding = 2) writeonly uniform image2D depth_out;

const int RADIUS = 4;
const int SIDE = 16 + 2 * RADIUS;
// The streaks are a texel or two wide whatever the fluid's size on the screen; never wider than the main kernel, though.
const float CLEAN_SIGMA = float(RADIUS) / 3.0;

shared float tile[SIDE * SIDE];

float fetchDepth(ivec2 texel) {
    const bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(frame.size.xy)));
    return inside ? texelFetch(depth_in, texel, 0).r : EMPTY_DEPTH;
}

void main() {
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 corner = ivec2(gl_WorkGroupID.xy) * 16 - RADIUS;
    for (int index = int(gl_LocalInvocationIndex); index < SIDE * SIDE; index += 256) {
        const float d = fetchDepth(corner + ivec2(index % SIDE, index / SIDE));
        tile[index] = isEmpty(d) ? 0.0 : 1.0 / d;
    }
    barrier();
    if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) {
        return;
    }
    const int centre = (int(gl_LocalInvocationID.y) + RADIUS) * SIDE + int(gl_LocalInvocationID.x) + RADIUS;
    const float reciprocal = tile[centre];
    if (reciprocal <= 0.0) {
        imageStore(depth_out, texel, vec4(EMPTY_DEPTH));
        return;
    }
    const float depth = 1.0 / reciprocal;
    const Range range = rangeOf(depth);
    const float sigma = min(CLEAN_SIGMA, sigmaPixels(depth, min(frame.focal.x, frame.focal.y)));
    const int reach = min(RADIUS, int(ceil(3.0 * sigma)));
    const float falloff = -0.5 / (sigma * sigma);
    float sum = reciprocal;
    float weights = 1.0;
    for (int k = 1; k <= reach; ++k) {
        const float weight = exp(falloff * float(k * k));
        addPair(range, tile[centre + k], tile[centre - k], weight, sum, weights);
        addPair(range, tile[centre + k * SIDE], tile[centre - k * SIDE], weight, sum, weights);
    }
    for (int y = 1; y <= reach; ++y) {
        for (int x = 1; x <= reach; ++x) {
            // Both diagonals' pairs in one step: a mirror only swaps them, and the sum stays the same to the bit.
            float values = 0.0;
            float count = 0.0;
            addPair(range, tile[centre + y * SIDE + x], tile[centre - y * SIDE - x], 1.0, values, count);
            addPair(range, tile[centre + y * SIDE - x], tile[centre - y * SIDE + x], 1.0, values, count);
            const float weight = exp(falloff * float(x * x + y * y));
            sum += weight * values;
            weights += weight * count;
        }
    }
    imageStore(depth_out, texel, vec4(weights / sum));
}
