// SPDX-License-Identifier: MIT
#version 460
// Clear: what the fluid images say when there is no fluid: coverage 0, depth 1, normal and thickness 0.
// An output that the host does not read is a 1x1 placeholder; a store outside an image has no effect.
// Bound of its test: bit for bit.
layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 0) writeonly uniform image2D fluid_colour;
layout(set = 0, binding = 1) writeonly uniform image2D fluid_depth;
layout(set = 0, binding = 2) writeonly uniform image2D fluid_normal;
layout(set = 0, binding = 3) writeonly uniform image2D fluid_thickness;

void main() {
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(fluid_colour)))) {
        return;
    }
    imageStore(fluid_colour, texel, vec4(0.0));
    imageStore(fluid_depth, texel, vec4(1.0));
    imageStore(fluid_normal, texel, vec4(0.0));
    imageStore(fluid_thickness, texel, vec4(0.0));
}
