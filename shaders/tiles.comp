// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Which tiles have fluid in them or within a margin of them; what the other passes then run over.
// Inputs:  depth in metres, 1e30 = empty. Output: the list of tiles.glsl, in no particular order.
// One invocation walks over one tile: next to the passes that it saves the walk is nothing, and it needs no barrier.
// Bound of its test: no pixel of fluid is missed, exactly.
#include "frame.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
    uvec2 count;  // tiles in x and y
    uint side;    // of a tile, pixels
    uint margin;  // pixels around it that count as well
} push;

layout(std430, set = 0, binding = 1) buffer Tiles {
    uint groups_x, groups_y, groups_z, number;
    uint tile[];
} tiles;
layout(set = 0, binding = 2) uniform texture2D depth_in;

const uint TILES_PER_ROW = 32768u;  // see tiles.glsl

void main() {
    if (gl_GlobalInvocationID.x >= push.count.x * push.count.y) {
        return;
    }
    const uvec2 at = uvec2(gl_GlobalInvocationID.x % push.count.x, gl_GlobalInvocationID.x / push.count.x);
    const ivec2 size = ivec2(frame.size.xy);
    const ivec2 first = max(ivec2(at * push.side) - int(push.margin), ivec2(0));
    const ivec2 last = min(ivec2((at + 1u) * push.side + push.margin), size);
    bool found = false;
    for (int y = first.y; y < last.y && !found; ++y) {
        float nearest = EMPTY_DEPTH;
        for (int x = first.x; x < last.x; ++x) {
            nearest = min(nearest, texelFetch(depth_in, ivec2(x, y), 0).r);
        }
        found = !isEmpty(nearest);
    }
    if (found) {
        const uint index = atomicAdd(tiles.number, 1u);
        tiles.tile[index] = at.x | (at.y << 16);
        atomicMax(tiles.groups_x, min(index + 1u, TILES_PER_ROW));
        atomicMax(tiles.groups_y, index / TILES_PER_ROW + 1u);
    }
}
