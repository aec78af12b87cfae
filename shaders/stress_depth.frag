// SPDX-License-Identifier: MIT
#version 460
// Stress: a turn into D32F. Bound of its test: bit for bit.
#extension GL_GOOGLE_include_directive : require
#include "stress_images.glsl"

void main() {
    gl_FragDepth = float(turnOver(ivec2(gl_FragCoord.xy))) / 16777216.0;
}
