// SPDX-License-Identifier: MIT
// For the vertex stage of a splat: a point or a triangle around bounds on the screen.
// VERTICES = 1: a point, the square around the rectangle: one vertex, and no setup of edges. 3: one triangle around the
// rectangle, for the splats whose rectangle may be wider than the widest point.
#ifndef SLUICE_PLACE_SPLAT_GLSL
#define SLUICE_PLACE_SPLAT_GLSL
#include "splat.glsl"

layout(constant_id = 0) const uint VERTICES = 1u;
layout(constant_id = 1) const uint SCALED = 0u;  // 1: the target has frame.thickness.x pixels per texel

// `bounds`: NDC, low and high corner, low > high if there are none. `near`: isNear of the centre.
void placeSplat(vec4 bounds, vec3 eye, bool near, uint corner) {
    const float scale = SCALED != 0u ? frame.thickness.x : 1.0;
    // The target may reach beyond the picture by less than a texel, whose centre can lie on the picture's very edge.
    const vec2 target = ceil(frame.size.xy / scale);
    const vec2 beyond = 2.0 * target * scale * frame.size.zw - 1.0;
    bounds = vec4(max(bounds.xy, vec2(-1.0)), min(bounds.zw, beyond));
    // Texel centres inside the bounds; a splat between them costs no triangle.
    const vec4 texels = (bounds * 0.5 + 0.5) * frame.size.xyxy / scale;
    const bool touches = all(lessThanEqual(ceil(texels.xy - 0.5), floor(texels.zw - 0.5)));
    const bool other = near != (VERTICES == 3u);
    // Negated so that a NaN position is dropped, too.
    gl_PointSize = 1.0;
    if (other || !touches || !all(lessThan(abs(eye), vec3(1e15)))) {
        gl_Position = vec4(-2.0, -2.0, 0.5, 1.0);
        return;
    }
    if (VERTICES == 1u) {
        // A point's position and size may be rounded to 1/16 of a pixel on a device and to 1/256 on llvmpipe.
        const vec2 extent = texels.zw - texels.xy;
        gl_Position = vec4((texels.xy + texels.zw) / target - 1.0, 0.5, 1.0);
        gl_PointSize = max(extent.x, extent.y) + 0.125;
        return;
    }
    const vec2 along = vec2(corner == 1u ? 2.0 : 0.0, corner == 2u ? 2.0 : 0.0);
    const vec2 texel = texels.xy + along * (texels.zw - texels.xy);
    gl_Position = vec4(2.0 * texel / target - 1.0, 0.5, 1.0);
}

#endif
