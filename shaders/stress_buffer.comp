// SPDX-License-Identifier: MIT
#version 460
// Stress: a turn over buffers of words. Bound of its test: bit for bit.
#extension GL_GOOGLE_include_directive : require
#include "stress.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer In0 { uint in0[]; };
layout(std430, set = 0, binding = 1) readonly buffer In1 { uint in1[]; };
layout(std430, set = 0, binding = 2) readonly buffer In2 { uint in2[]; };
layout(std430, set = 0, binding = 3) readonly buffer In3 { uint in3[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Result { uint result[]; };

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= turn.texels) {
        return;
    }
    uint x = mixWord(0u, turn.inputs == 0u ? 0u : in0[index], turn.salt, index);
    if (turn.inputs > 1u) {
        x = mixWord(x, in1[index], turn.salt + 1u, index);
    }
    if (turn.inputs > 2u) {
        x = mixWord(x, in2[index], turn.salt + 2u, index);
    }
    if (turn.inputs > 3u) {
        x = mixWord(x, in3[index], turn.salt + 3u, index);
    }
    result[index] = x;
}
