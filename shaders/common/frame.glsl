// SPDX-License-Identifier: MIT
// The frame's constants (set 0, binding 0) and the geometry that follows from them.
// Mirror of renderer_vk/src/passes/frame_constants.hpp. Metres; eye space is right-handed and looks down -z.
#ifndef SLUICE_FRAME_GLSL
#define SLUICE_FRAME_GLSL

const uint LOOKS = 8u;  // SLUICE_MAX_FLUIDS

layout(std140, set = 0, binding = 0) uniform Frame {
    mat4 view;          // world to eye
    vec4 projection;    // ndc = projection.xy * slope - projection.zw, slope = eye.xy / depth
    vec4 depth_range;   // ndc z = x + y / depth; near plane, far plane
    vec4 size;          // pixels: width, height, 1 / width, 1 / height
    vec4 focal;         // pixels per unit slope in x and y; splat radius, particle radius
    vec4 absorption;    // per metre; w = index of refraction
    vec4 scatter;       // linear; w = specular power
    vec4 zenith, horizon, ground;
    vec4 to_sun;        // unit, eye space
    vec4 sun_radiance;
    vec4 filter_widths; // delta, mu, sigma; w = cap in pixels
    vec4 thickness;     // pixels per thickness texel; sigma of the blur; chord weight; depth below which no point is wide enough
    uvec4 modes;        // x = encoding of HOST_DEPTH, y = particles, z = bits of the longest axis of a splat in splat radii, w = bits of SluiceFluid::foam
    vec4 looks[LOOKS];  // absorption of each fluid, per metre; of frames with several looks
} frame;

// The depth of "nothing here". Every real depth is far below it.
const float EMPTY_DEPTH = 1e30;
bool isEmpty(float depth) { return depth > 1e29; }

float nearPlane() { return frame.depth_range.z; }
float farPlane() { return frame.depth_range.w; }
float splatRadius() { return frame.focal.z; }
// The farthest that a splat reaches from its centre.
float splatReach() { return frame.focal.z * uintBitsToFloat(frame.modes.z); }
float particleRadius() { return frame.focal.w; }

// The eye-space direction through a pixel position (x right, y up, (0.5, 0.5) is the centre of texel (0,0)), scaled so
// that z = -1: depth times this is the eye-space point.
vec3 rayThrough(vec2 pixel) {
    const vec2 ndc = pixel * (2.0 * frame.size.zw) - 1.0;
    return vec3((ndc + frame.projection.zw) / frame.projection.xy, -1.0);
}

// Pixel position of an eye-space point in front of the eye.
vec2 pixelOf(vec3 eye) {
    const vec2 ndc = frame.projection.xy * (eye.xy / -eye.z) - frame.projection.zw;
    return (ndc * 0.5 + 0.5) * frame.size.xy;
}

// OpenGL window depth in [0,1] of a depth in metres, and back.
float windowDepth(float depth) {
    return clamp((frame.depth_range.x + frame.depth_range.y / depth) * 0.5 + 0.5, 0.0, 1.0);
}
float linearDepth(float window) { return frame.depth_range.y / (window * 2.0 - 1.0 - frame.depth_range.x); }

// A raw value of HOST_DEPTH as metres. Background (window depth 1, linear +inf) becomes EMPTY_DEPTH, so that no infinity
// enters arithmetic.
float sceneDepth(float raw) {
    // A choice between values and not a branch: lavapipe (Mesa 22.3) makes a shader of its own for a branch on a uniform, anew
    // for each frame, and keeps them all.
    const bool linear = frame.modes.x != 0u;
    const float metres = mix(linearDepth(raw), raw, linear);
    return raw < mix(1.0, 1e29, linear) ? metres : EMPTY_DEPTH;
}

#endif
