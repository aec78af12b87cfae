// SPDX-License-Identifier: MIT
#include "payload/placement.hpp"

#include <algorithm>
#include <cmath>

namespace sluice::inject {

namespace {

using Vector = std::array<double, 3>;

Vector normalised(const Vector& v) {
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}

double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Columns and a translation.
Matrix frame(const Vector& x, const Vector& y, const Vector& z, const Vector& origin) {
    Matrix m = kIdentity;
    for (std::size_t i = 0; i < 3; ++i) {
        m.at(i) = static_cast<float>(x.at(i));
        m.at(4 + i) = static_cast<float>(y.at(i));
        m.at(8 + i) = static_cast<float>(z.at(i));
        m.at(12 + i) = static_cast<float>(origin.at(i));
    }
    return m;
}

Vector column(const Matrix& m, std::size_t i) {
    return {double{m.at(4 * i)}, double{m.at(4 * i + 1)}, double{m.at(4 * i + 2)}};
}

/// Of a rigid motion.
Matrix inverse(const Matrix& m) {
    const Vector at = column(m, 3);
    const Vector origin{-dot(column(m, 0), at), -dot(column(m, 1), at), -dot(column(m, 2), at)};
    return frame({double{m[0]}, double{m[4]}, double{m[8]}}, {double{m[1]}, double{m[5]}, double{m[9]}},
                 {double{m[2]}, double{m[6]}, double{m[10]}}, origin);
}

Vector inDouble(const Triple& t) {
    return {double{t[0]}, double{t[1]}, double{t[2]}};
}

Matrix inMetres(Matrix view, double metres) {
    for (const std::size_t i : {12U, 13U, 14U}) {
        view.at(i) = static_cast<float>(double{view.at(i)} * metres);
    }
    return view;
}

constexpr double kShare = 0.6;  // of half the picture that the box takes

}  // namespace

Triple upOf(const Matrix& view) {
    constexpr double kLevel = 0.02;   // sine of a roll that is none
    constexpr double kRolled = 0.15;  // and of one that is beyond doubt
    constexpr std::size_t kY = 4;     // columns: where the world's axes point for the eye
    constexpr std::size_t kZ = 8;
    const double roll_y = std::abs(double{view[kY]});
    const double roll_z = std::abs(double{view[kZ]});
    const auto up_y = double{view[kY + 1]};
    const auto up_z = double{view[kZ + 1]};
    const bool only_z = roll_y > kRolled;
    return roll_z < kLevel && up_z > 0.1 && (only_z || (roll_y < kLevel && up_z > up_y)) ? Triple{0, 0, 1}
                                                                                         : Triple{0, 1, 0};
}

Placement::Placement(const WaterPlan& plan, const FoundCamera& first, double distance) {
    const Lens& lens = first.lens;
    const double seen =
        distance > 0.0 ? distance : std::sqrt(lens.near_plane * std::min(lens.far_plane, 1e4 * lens.near_plane));
    const Vector low = inDouble(plan.low);
    const Vector high = inDouble(plan.high);
    const double half = 0.5 * std::max(high[0] - low[0], high[1] - low[1]);
    // As far away as the box must be to take that share of the picture, in metres, over the same in units.
    const double fitting = half / kShare * std::max(lens.scale_x, lens.scale_y);
    metres_ = plan.units_per_metre > 0 ? 1.0 / double{plan.units_per_metre} : fitting / seen;
    up_ = plan.up.value_or(upOf(first.view));
    if (!plan.in_view) {
        return;
    }
    const Matrix view = inMetres(first.view, metres_);
    const Vector up_in_world = normalised(inDouble(up_));
    Vector up{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            up.at(i) += column(view, k).at(i) * up_in_world.at(k);
        }
    }
    // Upright, and turned to face the eye as far as that goes; an eye that looks along its own x sees it from there.
    Vector right{1, 0, 0};
    if (std::abs(up[0]) > 0.9) {
        right = {0, 0, -1};
    }
    const double along = dot(right, up);
    right = normalised({right[0] - along * up[0], right[1] - along * up[1], right[2] - along * up[2]});
    const Vector toward = cross(right, up);
    Vector origin{0, 0, -seen * metres_};
    for (std::size_t i = 0; i < 3; ++i) {
        origin.at(i) -= 0.5 * ((low[0] + high[0]) * right.at(i) + (low[1] + high[1]) * up.at(i) +
                               (low[2] + high[2]) * toward.at(i));
    }
    from_fluid_ = product(inverse(view), frame(right, up, toward, origin));
}

PlacedCamera Placement::camera(const FoundCamera& found) const {
    Lens lens = found.lens;
    lens.near_plane *= metres_;
    lens.far_plane *= metres_;
    return {product(inMetres(found.view, metres_), from_fluid_), projectionOf(lens, found.zero_to_one)};
}

}  // namespace sluice::inject
