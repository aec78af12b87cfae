// SPDX-License-Identifier: MIT
// The narrow-range rule of Truong & Yuksel 2018, "A Narrow-Range Filter for Screen-Space Fluid Rendering", on reciprocal
// depth. The reciprocal depth of a plane is an affine function of the pixel, so that a symmetric average of it leaves a
// plane exactly where it was, at any slope; the average of depth itself does not. The range is still taken in metres.
#ifndef SLUICE_NARROW_RANGE_GLSL
#define SLUICE_NARROW_RANGE_GLSL
#include "frame.glsl"

// How a pixel sees its neighbours. Depths are metres, 1e30 = empty.
struct Range {
    float nearest;   // nearer than this is another surface in front: it is left out, and its mirror sample
    float farthest;  // farther is another surface behind: it counts as `clamped`, which is a reciprocal
    float clamped;
};

Range rangeOf(float depth) {
    const float delta = frame.filter_widths.x;
    return Range(max(depth - delta, 0.0), depth + delta, 1.0 / (depth + frame.filter_widths.y));
}

// Standard deviation in pixels: constant in the world, and a third of the cap at most, so that the kernel that the cap cuts
// is still a Gaussian.
float sigmaPixels(float depth, float focal) {
    return min(frame.filter_widths.z * focal / depth, frame.filter_widths.w / 3.0);
}
int halfWidth(float sigma) { return int(min(ceil(3.0 * sigma), frame.filter_widths.w)); }

// Adds a sample and its mirror image, or neither: one-sided windows would pull the surface towards the kept side.
void addPair(Range range, float a, float b, float weight, inout float sum, inout float weights) {
    const float w = min(a, b) >= range.nearest && !isEmpty(max(a, b)) ? weight : 0.0;
    sum += w * ((a > range.farthest ? range.clamped : 1.0 / a) + (b > range.farthest ? range.clamped : 1.0 / b));
    weights += 2.0 * w;
}

#endif
