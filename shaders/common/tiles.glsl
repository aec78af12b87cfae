// SPDX-License-Identifier: MIT
// The list of tiles that have fluid, as a pass reads it; tiles.comp writes it. Set 0, binding 1. Dispatched indirectly, a
// workgroup per tile, so that a pixel without fluid near it costs nothing, on a GPU as on a software rasteriser, where an
// early return would still walk through the whole shader.
#ifndef SLUICE_TILES_GLSL
#define SLUICE_TILES_GLSL

const uint TILE = 16u;              // texels; kTileTexels
const uint TILES_PER_ROW = 32768u;  // of the dispatch: devices promise 65535 workgroups each way

layout(std430, set = 0, binding = 1) readonly buffer Tiles {
    uvec4 groups;  // x, y, z of the dispatch; w = number of tiles
    uint tile[];   // x | y << 16
} tiles;

// The texel of this invocation, or one outside every image for the workgroups that fill up the dispatch's last row.
ivec2 tileTexel() {
    const uint index = gl_WorkGroupID.y * TILES_PER_ROW + gl_WorkGroupID.x;
    const uint tile = index < tiles.groups.w ? tiles.tile[index] : 0xffffffffu;
    return ivec2(uvec2(tile & 0xffffu, tile >> 16) * TILE + gl_LocalInvocationID.xy);
}

#endif
