// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Eye-space normals of the depth image.
// Inputs:  depth in metres, 1e30 = empty. Output: xyz = unit normal that faces the eye, w = 1; zero where empty.
// Each axis takes the central difference where the depth bends gently, the smaller of the two one-sided differences where
// it breaks, and a blend between, so that no line appears where the rule changes. An axis without neighbours is taken to
// face the eye, and so does a pixel without any.
// Bound of its test: 0.12 degrees, the step of the output format included.
#include "frame.glsl"
#include "tiles.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 2) uniform texture2D depth_in;
layout(set = 0, binding = 3) writeonly uniform image2D normal_out;

float depthAt(ivec2 texel) {
    const bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(frame.size.xy)));
    return inside ? texelFetch(depth_in, texel, 0).r : EMPTY_DEPTH;
}

vec3 pointAt(ivec2 texel, float depth) { return depth * rayThrough(vec2(texel) + 0.5); }

// The tangent along `step`, or zero if no neighbour has fluid. `bend` is the second difference of depth that still counts
// as one surface.
vec3 tangentAlong(ivec2 texel, ivec2 step, float depth, vec3 point, float bend) {
    const float ahead = depthAt(texel + step);
    const float behind = depthAt(texel - step);
    if (isEmpty(ahead) && isEmpty(behind)) {
        return vec3(0.0);
    }
    const vec3 forward = isEmpty(ahead) ? vec3(0.0) : pointAt(texel + step, ahead) - point;
    const vec3 backward = isEmpty(behind) ? vec3(0.0) : point - pointAt(texel - step, behind);
    if (isEmpty(ahead)) {
        return backward;
    }
    if (isEmpty(behind)) {
        return forward;
    }
    const vec3 smaller = abs(ahead - depth) < abs(depth - behind) ? forward : backward;
    const float broken = smoothstep(bend, 2.0 * bend, abs(ahead - 2.0 * depth + behind));
    return mix(0.5 * (forward + backward), smaller, broken);
}

void main() {
    const ivec2 texel = tileTexel();
    if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) {
        return;
    }
    const float depth = texelFetch(depth_in, texel, 0).r;
    if (isEmpty(depth)) {
        imageStore(normal_out, texel, vec4(0.0));
        return;
    }
    const vec3 point = pointAt(texel, depth);
    const vec3 to_eye = -normalize(point);
    // Within half a radius, or half a pixel's footprint, neighbours may belong to one surface.
    const float bend = 0.5 * max(particleRadius(), depth / min(frame.focal.x, frame.focal.y));
    const vec3 x = tangentAlong(texel, ivec2(1, 0), depth, point, bend);
    const vec3 y = tangentAlong(texel, ivec2(0, 1), depth, point, bend);
    const bool has_x = dot(x, x) > 0.0;
    const bool has_y = dot(y, y) > 0.0;
    vec3 normal = to_eye;
    if (has_x && has_y) {
        normal = normalize(cross(normalize(x), normalize(y)));
        normal = dot(normal, to_eye) < 0.0 ? -normal : normal;
    } else if (has_x || has_y) {
        const vec3 tangent = normalize(has_x ? x : y);
        normal = normalize(to_eye - dot(to_eye, tangent) * tangent);
    }
    imageStore(normal_out, texel, vec4(normal, 1.0));
}
