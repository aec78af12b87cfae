// SPDX-License-Identifier: MIT
// The procedural sky of sluice/plugin.h without its sun disc: shading adds the sun as a highlight lobe whose peak is the
// radiance that a mirror would show, so that the disc must not come a second time.
#ifndef SLUICE_SKY_GLSL
#define SLUICE_SKY_GLSL
#include "frame.glsl"

// Linear radiance for a unit world direction.
vec3 skyWithoutSun(vec3 direction) {
    return direction.y >= 0.0 ? mix(frame.horizon.rgb, frame.zenith.rgb, sqrt(direction.y))
                              : mix(frame.horizon.rgb, frame.ground.rgb, min(1.0, -4.0 * direction.y));
}

#endif
