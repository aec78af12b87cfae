// SPDX-License-Identifier: MIT
// The vertex of a splat of one of several looks: its fluid is a number for each particle, its look in the frame's table.
#ifndef SLUICE_LOOKS_GLSL
#define SLUICE_LOOKS_GLSL
#include "frame.glsl"

layout(std430, set = 0, binding = 3) readonly buffer Fluids { uint fluid[]; };

layout(location = 3) flat out vec3 out_absorption;  // 1/m, linear RGB

vec3 absorptionOf(uint particle) { return frame.looks[min(fluid[particle], LOOKS - 1u)].rgb; }

#endif
