// SPDX-License-Identifier: MIT
// A sphere on the screen: its exact bounds, and where a ray meets it.
#ifndef SLUICE_SPLAT_GLSL
#define SLUICE_SPLAT_GLSL
#include "frame.glsl"

// Depth of a world position. `precise`, so that every shader decides alike which way a sphere is drawn: drawn twice, it
// would count twice in the thickness.
float depthOf(vec3 world) {
    precise const float depth = -(frame.view[0].z * world.x + frame.view[1].z * world.y + frame.view[2].z * world.z +
                                  frame.view[3].z);
    return depth;
}

// Too near to be drawn as a point: its rectangle may be wider than the device's widest point.
bool isNear(float depth) { return depth < frame.thickness.w; }

// Slopes (offset / depth) between which a disc of centre (x, depth) and radius r lies, seen from the origin, counting only
// its part beyond the near plane. Each side is the tangent line, or, where the tangent touches nearer than the near plane
// (or the eye is inside), the end of the chord that the near plane cuts. After Mara & McGuire 2013, "2D Polyhedral Bounds
// of a Clipped, Perspective-Projected 3D Sphere", derived anew. The disc reaches beyond the near plane.
vec2 slopeBounds(float x, float depth, float r) {
    const float near = nearPlane();
    const float chord_squared = r * r - (near - depth) * (near - depth);
    const float chord = sqrt(max(chord_squared, 0.0));
    vec2 bounds = vec2(x - chord, x + chord) / near;
    const float squared = x * x + depth * depth;
    const float tangent_squared = squared - r * r;
    if (tangent_squared > 0.0) {
        const float t = sqrt(tangent_squared);
        // The tangent points are t/squared * (t * centre -+ r * perpendicular); only their signs and ratios matter.
        const float low_depth = depth * t + x * r;
        const float high_depth = depth * t - x * r;
        if (low_depth * t > near * squared) {
            bounds.x = (x * t - depth * r) / low_depth;
        }
        if (high_depth * t > near * squared) {
            bounds.y = (x * t + depth * r) / high_depth;
        }
    }
    return bounds;
}

// The screen rectangle of a sphere in NDC: (low.xy, high.xy); low > high if it has none.
vec4 ndcBounds(vec3 eye, float r) {
    const float depth = -eye.z;
    if (depth + r <= nearPlane() || depth - r >= farPlane()) {
        return vec4(1.0, 1.0, -1.0, -1.0);
    }
    const vec2 x = slopeBounds(eye.x, depth, r) * frame.projection.x - frame.projection.z;
    const vec2 y = slopeBounds(eye.y, depth, r) * frame.projection.y - frame.projection.w;
    // A hundredth of a pixel more than exact, so that rounding never takes a silhouette pixel.
    const vec2 margin = 0.02 * frame.size.zw;
    const vec2 low = vec2(min(x.x, x.y), min(y.x, y.y)) - margin;
    const vec2 high = vec2(max(x.x, x.y), max(y.x, y.y)) + margin;
    return vec4(low, high);
}

// The depths at which the ray `ray` (z = -1) enters and leaves a sphere, or x > y if it misses. The discriminant is taken
// at the foot of the perpendicular, where nothing cancels (Haines & Akenine-Moeller, "Precision Improvements for Ray/Sphere
// Intersection", Ray Tracing Gems 2019, ch. 7).
vec2 depthsInSphere(vec3 ray, vec3 eye, float r) {
    const float inverse = 1.0 / dot(ray, ray);
    const float foot = dot(eye, ray) * inverse;
    const vec3 offset = eye - foot * ray;
    const float discriminant = r * r - dot(offset, offset);
    if (discriminant <= 0.0) {
        return vec2(1.0, -1.0);
    }
    const float half_chord = sqrt(discriminant * inverse);
    return vec2(foot - half_chord, foot + half_chord);
}

#endif
