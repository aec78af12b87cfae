// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// One direction of the Gaussian blur of thickness: x (ALONG = 0) writes weighted sums and weights, y (1) their quotient.
// Inputs:  ALONG = 0: thickness in metres; 1: the sums of the x direction. The fluid's depth, for the kernel's width.
// Outputs: ALONG = 0: sum of weight * thickness, sum of weights; 1: metres.
// With several looks the optical depth beside it, channel by channel with the same weights; else that is a placeholder.
// Only texels with fluid count (normalised convolution, Knutsson & Westin 1993). A zero means "outside the outline" or
// "hidden by the scene", and neither says anything about the thickness beside it: counting them would thin and so brighten
// every outline and every edge of a pillar. The thinning that is real is already in the chords. A texel beside the outline
// gets the mean of its neighbours, so that reading between texels finds no hole there.
// Bound of its test: 1e-5 of the largest thickness.
#include "frame.glsl"
#include "tiles.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(constant_id = 0) const uint ALONG = 0u;
layout(constant_id = 1) const uint SEVERAL = 0u;

layout(set = 0, binding = 2) uniform texture2D thickness_in;
layout(set = 0, binding = 3) uniform texture2D depth_in;
layout(set = 0, binding = 4) writeonly uniform image2D thickness_out;
layout(set = 0, binding = 5) uniform texture2D optical_in;
layout(set = 0, binding = 6) writeonly uniform image2D optical_out;

const float CAP = 24.0;  // texels; beyond it a near camera would pay for detail that it cannot see

// The nearest fluid in the texel and the eight around it, one look at each.
float nearestDepth(ivec2 texel) {
    const float scale = frame.thickness.x;
    float nearest = EMPTY_DEPTH;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            const ivec2 pixel = ivec2((vec2(texel + ivec2(x, y)) + 0.5) * scale);
            nearest = min(nearest, texelFetch(depth_in, clamp(pixel, ivec2(0), ivec2(frame.size.xy) - 1), 0).r);
        }
    }
    return nearest;
}

void main() {
    const ivec2 texel = tileTexel();
    const ivec2 size = imageSize(thickness_out);
    if (any(greaterThanEqual(texel, size))) {
        return;
    }
    const float depth = nearestDepth(texel);
    // Outside the fluid and beside it by less than a texel: a kernel of one texel only closes the outline.
    const float focal = (ALONG == 0u ? frame.focal.x : frame.focal.y) / frame.thickness.x;
    const float sigma = isEmpty(depth) ? 0.5 : clamp(frame.thickness.y * focal / depth, 0.5, CAP / 3.0);
    const int reach = int(min(ceil(3.0 * sigma), CAP));
    const float falloff = -0.5 / (sigma * sigma);
    float sum = 0.0;
    float weights = 0.0;
    vec3 optical = vec3(0.0);
    const int limit = ALONG == 0u ? size.x : size.y;
    const int here = ALONG == 0u ? texel.x : texel.y;
    for (int k = max(-reach, -here); k <= min(reach, limit - 1 - here); ++k) {
        const float weight = exp(falloff * float(k * k));
        if (SEVERAL != 0u) {
            optical += weight * texelFetch(optical_in, texel + (ALONG == 0u ? ivec2(k, 0) : ivec2(0, k)), 0).rgb;
        }
        if (ALONG == 0u) {
            const float thickness = texelFetch(thickness_in, texel + ivec2(k, 0), 0).r;
            sum += weight * thickness;
            weights += thickness > 0.0 ? weight : 0.0;
        } else {
            const vec2 sums = texelFetch(thickness_in, texel + ivec2(0, k), 0).rg;
            sum += weight * sums.x;
            weights += weight * sums.y;
        }
    }
    if (ALONG == 0u) {
        imageStore(thickness_out, texel, vec4(sum, weights, 0.0, 0.0));
    } else {
        imageStore(thickness_out, texel, vec4(weights > 0.0 ? sum / weights : 0.0));
    }
    if (SEVERAL != 0u) {
        const float whole = ALONG == 0u ? 1.0 : weights;
        imageStore(optical_out, texel, vec4(whole > 0.0 ? optical / whole : vec3(0.0), 0.0));
    }
}
