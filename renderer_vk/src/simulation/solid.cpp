// SPDX-License-Identifier: MIT
#include "simulation/solid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "simulation/vector.hpp"

namespace sluice::vk {
namespace {

double distanceToBox(const Solid& solid, const Triple& x) {
    const Vector local = turnedBack(solid.turn, minus(wide(x), wide(solid.a)));
    Vector out{};
    double inner = -1e300;
    for (std::size_t i = 0; i < 3; ++i) {
        out[i] = std::abs(local[i]) - double{solid.b[i]};
        inner = std::max(inner, out[i]);
        out[i] = std::max(out[i], 0.0);
    }
    return inner > 0.0 ? length(out) : inner;
}

}  // namespace

Solid planeSolid(const Triple& normal, const Triple& through) {
    const double norm = length(wide(normal));
    Solid solid;
    solid.kind = SolidKind::Plane;
    for (std::size_t i = 0; i < 3; ++i) {
        solid.a[i] = static_cast<float>(double{normal[i]} / norm);
    }
    solid.radius = static_cast<float>(dot(wide(solid.a), wide(through)));
    return solid;
}

Solid sphereSolid(const Triple& centre, float radius) {
    return {SolidKind::Sphere, centre, {}, radius, {0, 0, 0, 1}};
}

Solid capsuleSolid(const Triple& a, const Triple& b, float radius) {
    return {SolidKind::Capsule, a, b, radius, {0, 0, 0, 1}};
}

Solid boxSolid(const Triple& centre, const Triple& half, float degrees_about_y) {
    const double angle = double{degrees_about_y} * std::numbers::pi / 360.0;
    return {SolidKind::Box,
            centre,
            half,
            0.0F,
            {0, static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))}};
}

double distanceTo(const Solid& solid, const Triple& x) {
    if (solid.kind == SolidKind::Plane) {
        return dot(wide(solid.a), wide(x)) - double{solid.radius};
    }
    if (solid.kind == SolidKind::Box) {
        return distanceToBox(solid, x);
    }
    const Vector axis = solid.kind == SolidKind::Capsule ? minus(wide(solid.b), wide(solid.a)) : Vector{};
    Vector away = minus(wide(x), wide(solid.a));
    const double square = dot(axis, axis);
    const double along = square > 0.0 ? std::clamp(dot(away, axis) / square, 0.0, 1.0) : 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        away[i] -= along * axis[i];
    }
    return length(away) - double{solid.radius};
}

}  // namespace sluice::vk
