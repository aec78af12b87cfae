// SPDX-License-Identifier: MIT
#include "simulation/solid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace sluice::vk {
namespace {

SolidContact contactWithBox(const Solid& solid, const Vector& x) {
    const Vector local = turnedBack(solid.turn, minus(x, wide(solid.a)));
    Vector out{};
    std::size_t face = 0;  // the nearest; of equal ones the first
    for (std::size_t i = 0; i < 3; ++i) {
        out[i] = std::abs(local[i]) - double{solid.b[i]};
        face = out[i] > out[face] ? i : face;
    }
    Vector normal{};
    double distance = out[face];
    if (distance > 0.0) {
        for (std::size_t i = 0; i < 3; ++i) {
            normal[i] = std::max(out[i], 0.0);
        }
        distance = length(normal);
        normal = times(1.0 / distance, normal);
    } else {
        normal[face] = 1.0;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        normal[i] = std::copysign(normal[i], local[i]);
    }
    return {turned(solid.turn, normal), distance};
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

SolidContact contactWith(const Solid& solid, const Vector& x) {
    if (solid.kind == SolidKind::Plane) {
        return {wide(solid.a), dot(wide(solid.a), x) - double{solid.radius}};
    }
    if (solid.kind == SolidKind::Box) {
        return contactWithBox(solid, x);
    }
    const Vector axis = solid.kind == SolidKind::Capsule ? minus(wide(solid.b), wide(solid.a)) : Vector{};
    const Vector from = minus(x, wide(solid.a));
    const double square = dot(axis, axis);
    const double along = square > 0.0 ? std::clamp(dot(from, axis) / square, 0.0, 1.0) : 0.0;
    const Vector away = minus(from, times(along, axis));
    const double distance = length(away);
    return {distance > 1e-20 ? times(1.0 / distance, away) : Vector{0, 1, 0}, distance - double{solid.radius}};
}

double distanceTo(const Solid& solid, const Triple& x) {
    return contactWith(solid, wide(x)).distance;
}

}  // namespace sluice::vk
