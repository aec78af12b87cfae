// SPDX-License-Identifier: MIT
// What of a splat counts as thickness. The weight makes a lattice of spacing 2r add up to its own depth in metres. Only the
// part of the chord between the near plane and the scene counts.
#ifndef SLUICE_THICKNESS_GLSL
#define SLUICE_THICKNESS_GLSL
#include "frame.glsl"

layout(set = 0, binding = 2) uniform texture2D scene_depth;

// Metres along the ray `ray` (z = -1) through this texel, between two depths of it; 0 if there are none.
float thicknessBetween(vec2 depths, vec3 ray) {
    const float scene = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    const float chord = min(depths.y, scene) - max(depths.x, nearPlane());
    return depths.x > depths.y || chord <= 0.0 ? 0.0 : frame.thickness.z * chord * length(ray);
}

#endif
