// SPDX-License-Identifier: MIT
// Three numbers in double precision, and quaternions (x, y, z, w).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace sluice::vk {

using Vector = std::array<double, 3>;

template <typename T>
[[nodiscard]] Vector wide(const std::array<T, 3>& v) {
    return {double{v[0]}, double{v[1]}, double{v[2]}};
}
[[nodiscard]] inline std::array<float, 3> narrow(const Vector& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}
[[nodiscard]] inline Vector plus(const Vector& a, const Vector& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[nodiscard]] inline Vector times(double s, const Vector& v) {
    return {s * v[0], s * v[1], s * v[2]};
}
[[nodiscard]] inline Vector minus(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline double length(const Vector& v) {
    return std::sqrt(dot(v, v));
}
[[nodiscard]] inline Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
[[nodiscard]] inline Vector unit(const Vector& v) {
    return times(1.0 / length(v), v);
}
/// v turned by the unit quaternion: from its axes to the world's.
template <typename T>
[[nodiscard]] Vector turned(const std::array<T, 4>& q, const Vector& v) {
    const Vector axis{double{q[0]}, double{q[1]}, double{q[2]}};
    return plus(v, times(2.0, cross(axis, plus(cross(axis, v), times(double{q[3]}, v)))));
}
/// And back.
template <typename T>
[[nodiscard]] Vector turnedBack(const std::array<T, 4>& q, const Vector& v) {
    return turned(std::array<T, 4>{-q[0], -q[1], -q[2], q[3]}, v);
}

}  // namespace sluice::vk
