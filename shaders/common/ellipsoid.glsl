// SPDX-License-Identifier: MIT
// An ellipsoid on the screen: its exact bounds, and where a ray meets it.
#ifndef SLUICE_ELLIPSOID_GLSL
#define SLUICE_ELLIPSOID_GLSL
#include "splat.glsl"

// A symmetric matrix out of xx, xy, xz and yy, yz, zz.
mat3 symmetric(vec3 first, vec3 second) {
    return mat3(first, vec3(first.y, second.xy), vec3(first.z, second.yz));
}

// Adds the slope m, if the line of that slope through the origin touches the ellipse beyond the near plane. (x, depth) is the
// ellipse's centre; xx, xd, dd the square of what makes it out of the unit circle. Infinities and NaN add nothing.
vec2 withTangent(vec2 bounds, float m, float x, float depth, float xx, float xd, float dd, bool cut) {
    const float off = x - m * depth;
    const float touch = depth - (xd - m * dd) * (off / (xx - 2.0 * m * xd + m * m * dd));
    return !cut || touch >= nearPlane() ? vec2(min(bounds.x, m), max(bounds.y, m)) : bounds;
}

// As slopeBounds of a disc: slopes (offset / depth) between which the part of an ellipse beyond the near plane lies. They are
// those of the two tangents through the origin, or of the ends of the chord that the near plane cuts. A line x = m d touches
// where (x - m d)^2 = xx - 2 m xd + m^2 dd; that quadratic's discriminant is written without the terms that cancel.
vec2 slopeBoundsOfEllipse(float x, float depth, float xx, float xd, float dd) {
    const float near = nearPlane();
    vec2 bounds = vec2(1e30, -1e30);
    const float up = near - depth;
    const float left = 1.0 - up * up / dd;
    const bool cut = left > 0.0;
    if (cut) {
        const float middle = x + xd / dd * up;
        const float chord = sqrt(max(xx - xd * xd / dd, 0.0) * left);
        bounds = vec2(middle - chord, middle + chord) / near;
    }
    const float b = x * depth - xd;
    const float discriminant = x * x * dd - 2.0 * x * depth * xd + depth * depth * xx - (xx * dd - xd * xd);
    if (discriminant > 0.0) {
        const float q = b + (b < 0.0 ? -1.0 : 1.0) * sqrt(discriminant);
        bounds = withTangent(bounds, q / (depth * depth - dd), x, depth, xx, xd, dd, cut);
        bounds = withTangent(bounds, (x * x - xx) / q, x, depth, xx, xd, dd, cut);
    }
    return bounds;
}

// As ndcBounds, of the ellipsoid { eye + s u, |u| <= 1 } with s s^T = square.
vec4 ndcBoundsOfEllipsoid(vec3 eye, mat3 square) {
    const float depth = -eye.z;
    const float deep = sqrt(square[2].z);
    if (depth + deep <= nearPlane() || depth - deep >= farPlane()) {
        return vec4(1.0, 1.0, -1.0, -1.0);
    }
    // Depth grows along -z, so that the mixed terms change sign.
    const vec2 x = slopeBoundsOfEllipse(eye.x, depth, square[0].x, -square[0].z, square[2].z) * frame.projection.x -
                   frame.projection.z;
    const vec2 y = slopeBoundsOfEllipse(eye.y, depth, square[1].y, -square[1].z, square[2].z) * frame.projection.y -
                   frame.projection.w;
    const vec2 margin = 0.02 * frame.size.zw;
    const vec2 low = vec2(min(x.x, x.y), min(y.x, y.y)) - margin;
    const vec2 high = vec2(max(x.x, x.y), max(y.x, y.y)) + margin;
    return vec4(low, high);
}

// As depthsInSphere, of the ellipsoid about `eye` that `inverse` makes a unit sphere. The ray is followed from where it passes
// the centre's depth, and the discriminant taken at the foot of the perpendicular, so that large numbers do not cancel.
vec2 depthsInEllipsoid(vec3 ray, vec3 eye, mat3 inverse) {
    const float at = -eye.z;
    const vec3 away = inverse * vec3(at * ray.xy - eye.xy, 0.0);
    const vec3 along = inverse * ray;
    const float scale = 1.0 / dot(along, along);
    const float foot = dot(away, along) * scale;
    const vec3 offset = away - foot * along;
    const float discriminant = 1.0 - dot(offset, offset);
    if (discriminant <= 0.0) {
        return vec2(1.0, -1.0);
    }
    const float half_chord = sqrt(discriminant * scale);
    return vec2(at - foot - half_chord, at - foot + half_chord);
}

#endif
