// SPDX-License-Identifier: MIT
// For tests: many invocations add the same two numbers.
#version 460
#extension GL_GOOGLE_include_directive : require
#define BODIES_BINDING 1
#include "bodies.glsl"

layout(local_size_x = 64) in;

void main() {
    addWhole(0u, 4095.0);
    addWhole(2u, -1.0);
}
