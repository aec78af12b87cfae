// SPDX-License-Identifier: MIT
// Inputs of a turn over images. In memory row 0 is the first row on both sides, so that nobody flips.
#include "stress.glsl"

layout(set = 0, binding = 0) uniform sampler2D in0;
layout(set = 0, binding = 1) uniform sampler2D in1;
layout(set = 0, binding = 2) uniform sampler2D in2;
layout(set = 0, binding = 3) uniform sampler2D in3;

uint wordOf(vec4 texel) {
    if (kCodec == 0u) {
        const uvec4 bytes = uvec4(texel * 255.0 + 0.5);
        return bytes.r | bytes.g << 8 | bytes.b << 16 | bytes.a << 24;
    }
    return uint(kCodec == 2u ? texel.r * 16777216.0 : texel.r);
}

uint turnOver(ivec2 texel) {
    const uint index = uint(texel.y) * turn.width + uint(texel.x);
    if (turn.inputs == 0u) {
        return mixWord(0u, 0u, turn.salt, index);
    }
    uint x = mixWord(0u, wordOf(texelFetch(in0, texel, 0)), turn.salt, index);
    if (turn.inputs > 1u) {
        x = mixWord(x, wordOf(texelFetch(in1, texel, 0)), turn.salt + 1u, index);
    }
    if (turn.inputs > 2u) {
        x = mixWord(x, wordOf(texelFetch(in2, texel, 0)), turn.salt + 2u, index);
    }
    if (turn.inputs > 3u) {
        x = mixWord(x, wordOf(texelFetch(in3, texel, 0)), turn.salt + 3u, index);
    }
    return x;
}
