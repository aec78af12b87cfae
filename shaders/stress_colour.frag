// SPDX-License-Identifier: MIT
#version 460
// Stress: a turn into RGBA8 or R32F. Bound of its test: bit for bit.
#extension GL_GOOGLE_include_directive : require
#include "stress_images.glsl"

layout(location = 0) out vec4 result;

void main() {
    const uint x = turnOver(ivec2(gl_FragCoord.xy));
    result = kCodec == 0u ? vec4(uvec4(x, x >> 8, x >> 16, x >> 24) & 255u) / 255.0 : vec4(float(x), 0.0, 0.0, 1.0);
}
