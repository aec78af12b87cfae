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

/// From axis `from` to axis `to`.
inline Matrix rotation(std::size_t from, std::size_t to, double degrees) {
    const double a = degrees * 3.14159265358979 / 180.0;
    Matrix m = kIdentity;
    m.at(5 * from) = m.at(5 * to) = static_cast<float>(std::cos(a));
    m.at(4 * from + to) = static_cast<float>(std::sin(a));
    m.at(4 * to + from) = -m.at(4 * from + to);
    return m;
}

inline Matrix turn(double degrees) {  // about +y
    return rotation(2, 0, degrees);
}

inline Matrix pitch(double degrees) {  // about +x
    return rotation(1, 2, degrees);
}

inline Matrix scaling(float s) {
    Matrix m = kIdentity;
    m[0] = m[5] = m[10] = s;
    return m;
}

}  // namespace sluice::inject::test
