// SPDX-License-Identifier: MIT
#version 460
#extension GL_EXT_samplerless_texture_functions : require
// Echo: the host's images come back to it, texel for texel, without any fluid. What arrives is what crossed the hand-off.
// Inputs:  HOST_COLOUR (sRGB-encoded values, never decoded here), HOST_DEPTH (raw, in either encoding).
// Outputs: FLUID_COLOUR (all four channels), FLUID_DEPTH (the same number).
// Bound of its test: depth bit for bit; colour within half a step of 1/255.
layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 0) uniform texture2D host_colour;
layout(set = 0, binding = 1) uniform texture2D host_depth;
layout(set = 0, binding = 2) writeonly uniform image2D fluid_colour;
layout(set = 0, binding = 3) writeonly uniform image2D fluid_depth;

void main() {
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(fluid_colour)))) {
        return;
    }
    imageStore(fluid_colour, texel, texelFetch(host_colour, texel, 0));
    imageStore(fluid_depth, texel, vec4(texelFetch(host_depth, texel, 0).r));
}
