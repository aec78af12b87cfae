// SPDX-License-Identifier: MIT
// Matrices as the programs' own libraries make them.
#pragma once

#include <cmath>

#include "tracker/projection.hpp"

namespace sluice::inject::test {

inline Matrix frustum(double l, double r, double b, double t, double n, double f) {
    Matrix m{};
    m[0] = static_cast<float>(2 * n / (r - l));
    m[5] = static_cast<float>(2 * n / (t - b));
    m[8] = static_cast<float>((r + l) / (r - l));
    m[9] = static_cast<float>((t + b) / (t - b));
    m[10] = static_cast<float>(-(f + n) / (f - n));
    m[11] = -1;
    m[14] = static_cast<float>(-2 * f * n / (f - n));
    return m;
}

inline Matrix ortho() {
    Matrix m = kIdentity;
    m[0] = 2;
    m[5] = 2;
    m[10] = -1;
    m[12] = m[13] = -1;
    return m;
}

inline Matrix translation(float x, float y, float z) {
    Matrix m = kIdentity;
    m[12] = x;
    m[13] = y;
    m[14] = z;
    return m;
}

inline Matrix turn(double degrees) {  // about +y
    const double a = degrees * 3.14159265358979 / 180.0;
    Matrix m = kIdentity;
    m[0] = m[10] = static_cast<float>(std::cos(a));
    m[8] = static_cast<float>(std::sin(a));
    m[2] = -m[8];
    return m;
}

inline Matrix scaling(float s) {
    Matrix m = kIdentity;
    m[0] = m[5] = m[10] = s;
    return m;
}

}  // namespace sluice::inject::test
