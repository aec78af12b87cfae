// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// The host's depth as what the simulation's fluid collides with: metres along -z, of each `scale` times `scale` pixels the
// nearest, with the camera in front. Texels of no depth become 1e30.
// Input: HOST_DEPTH. Output: DepthHeader and depths, as shaders/simulation/seen.glsl reads them.
// Bound of its test: 2e-5 of the depth at up to a hundred near planes, of what the image holds.
layout(local_size_x = 16, local_size_y = 16) in;

layout(push_constant) uniform Push {
    vec4 row[3];
    vec4 lens, limits;
    uvec4 size;
    vec2 window;  // depth = y / (2 window depth - 1 - x)
    uint scale;   // pixels each way
    uint linear;  // 1: HOST_DEPTH is metres already
} push;
layout(set = 0, binding = 0) uniform texture2D host_depth;
layout(std430, set = 0, binding = 1) writeonly buffer Seen {
    vec4 seen_row[3];
    vec4 seen_lens, seen_limits;
    uvec4 seen_size;
    float seen_depth[];
};

float metres(float raw) {
    if (push.linear == 1u) {
        return raw > 0.0 && raw < 1e29 ? raw : 1e30;
    }
    return raw < 1.0 ? push.window.y / (raw * 2.0 - 1.0 - push.window.x) : 1e30;
}

void main() {
    const uvec2 texel = gl_GlobalInvocationID.xy;
    if (texel == uvec2(0)) {
        seen_row[0] = push.row[0];
        seen_row[1] = push.row[1];
        seen_row[2] = push.row[2];
        seen_lens = push.lens;
        seen_limits = push.limits;
        seen_size = push.size;
    }
    if (any(greaterThanEqual(texel, push.size.xy))) {
        return;
    }
    const ivec2 first = ivec2(texel * push.scale);
    const ivec2 last = min(first + int(push.scale), textureSize(host_depth, 0));
    float nearest = 1e30;
    for (int y = first.y; y < last.y; ++y) {
        for (int x = first.x; x < last.x; ++x) {
            nearest = min(nearest, metres(texelFetch(host_depth, ivec2(x, y), 0).r));
        }
    }
    seen_depth[texel.y * push.size.x + texel.x] = nearest;
}
