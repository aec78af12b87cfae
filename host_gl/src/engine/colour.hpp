// SPDX-License-Identifier: MIT
// Colours as this engine keeps them: sRGB-encoded, three floats in [0,1].
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "sluice/host_gl/engine.hpp"

namespace sluice::host {

/// IEC 61966-2-1 transfer function, linear to encoded, clamped to [0,1].
inline float encodeSrgb(float linear) {
    const float c = std::clamp(linear, 0.0F, 1.0F);
    return c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1.0F / 2.4F) - 0.055F;
}

inline Vec3 encodeSrgb(const Vec3& c) {
    return {encodeSrgb(c[0]), encodeSrgb(c[1]), encodeSrgb(c[2])};
}

inline Vec3 operator+(const Vec3& a, const Vec3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3 operator*(const Vec3& a, float s) {
    return {a[0] * s, a[1] * s, a[2] * s};
}

inline Vec3 mix(const Vec3& a, const Vec3& b, float t) {
    return a + (b - a) * t;
}

/// 0 below `low`, 1 above `high`, 3t^2 - 2t^3 between.
inline float smoothStep(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
    return t * t * (3.0F - 2.0F * t);
}

}  // namespace sluice::host
