// SPDX-License-Identifier: MIT
// The terms that the reference step is made of: kernels, contacts, walls by quadrature, fields. No code is shared with
// the solver.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "reference/simulation_reference.hpp"

namespace sluice::vk::test::reference {

inline constexpr double kPi = std::numbers::pi;

inline Vec operator+(const Vec& a, const Vec& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec operator-(const Vec& a, const Vec& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec operator*(double s, const Vec& v) {
    return {s * v[0], s * v[1], s * v[2]};
}
inline double dot(const Vec& a, const Vec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double norm(const Vec& v) {
    return std::sqrt(dot(v, v));
}
inline Vec cross(const Vec& a, const Vec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vec wide(const Triple& v) {
    return {double{v[0]}, double{v[1]}, double{v[2]}};
}

/// Simpson's rule over [from, h], which the polynomials below leave exact to round-off with this many parts.
template <typename F>
double integral(double from, double to, const F& f) {
    constexpr int kParts = 400;
    const double step = (to - from) / kParts;
    double sum = f(from) + f(to);
    for (int i = 1; i < kParts; ++i) {
        sum += (i % 2 == 1 ? 4.0 : 2.0) * f(from + i * step);
    }
    return sum * step / 3.0;
}

/// Those of the density constraint, of the kind that it has; all else has poly6 and spiky.
struct Kernels {
    double h;
    DensityKernel kind;
    double volume = 1.0, wall = 1.0, wall_slope = 1.0;

    explicit Kernels(double radius, DensityKernel kernel = DensityKernel::Poly6) : h(4.0 * radius), kind(kernel) {
        double sum = 0.0;
        double behind = 0.0;
        double slope = 0.0;
        for (int i = 0; i < 125; ++i) {
            const int cell[3] = {i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2};
            const Vec at{2.0 * radius * cell[0], 2.0 * radius * cell[1], 2.0 * radius * cell[2]};
            sum += value(norm(at));
            behind += at[0] < 0.0 ? value(norm(at)) : 0.0;
            slope += at[0] < 0.0 ? gradient(at)[0] : 0.0;
        }
        volume = 1.0 / sum;
        wall = volume * behind / halfSpace(radius);
        wall_slope = kind == DensityKernel::Poly6 ? 1.0 : volume * slope / halfSpaceSlope(radius);
    }
    /// In shells about a place so far from the plane.
    [[nodiscard]] double halfSpace(double distance) const {
        return integral(distance, h, [&](double r) { return 2.0 * kPi * r * (r - distance) * value(r); });
    }
    /// Over the plane that bounds it; of spiky, 15 / (pi h^6) (h - r)^3, with poly6.
    [[nodiscard]] double halfSpaceSlope(double distance) const {
        return wall_slope * integral(distance, h, [&](double r) {
                   const double spiky = 15.0 / (kPi * std::pow(h, 6)) * std::pow(h - r, 3);
                   return 2.0 * kPi * r * (kind == DensityKernel::Poly6 ? spiky : value(r));
               });
    }
    [[nodiscard]] double value(double r) const {
        const double q = r / h;
        const double cube = h * h * h;
        if (q >= 1.0) {
            return 0.0;
        }
        if (kind == DensityKernel::Poly6) {
            return 315.0 / (64.0 * kPi * cube) * std::pow(1.0 - q * q, 3);
        }
        if (kind == DensityKernel::Wendland) {
            return 21.0 / (2.0 * kPi * cube) * std::pow(1.0 - q, 4) * (1.0 + 4.0 * q);
        }
        return 8.0 / (kPi * cube) * (q <= 0.5 ? 6.0 * (q * q * q - q * q) + 1.0 : 2.0 * std::pow(1.0 - q, 3));
    }
    /// With respect to d; spiky's with poly6.
    [[nodiscard]] Vec gradient(const Vec& d) const {
        const double r = norm(d);
        const double q = r / h;
        if (!(r > 0.0 && q < 1.0)) {
            return {};
        }
        double slope = -45.0 * std::pow(1.0 - q, 2);
        if (kind == DensityKernel::Wendland) {
            slope = -210.0 * q * std::pow(1.0 - q, 3);
        } else if (kind == DensityKernel::Spline) {
            slope = 48.0 * (q <= 0.5 ? q * (3.0 * q - 2.0) : -std::pow(1.0 - q, 2));
        }
        return slope / (kPi * std::pow(h, 4) * r) * d;
    }
};

struct Contact {
    Vec normal;
    double distance;
};

inline Vec rotate(const std::array<float, 4>& q, const Vec& v, double sign) {
    const Vec u{sign * double{q[0]}, sign * double{q[1]}, sign * double{q[2]}};
    const auto w = double{q[3]};
    return 2.0 * dot(u, v) * u + (w * w - dot(u, u)) * v + 2.0 * w * cross(u, v);
}

inline Contact touching(const Solid& solid, const Vec& x) {
    const Vec a = wide(solid.a);
    const Vec b = wide(solid.b);
    if (solid.kind == SolidKind::Plane) {
        return {a, dot(a, x) - double{solid.radius}};
    }
    if (solid.kind == SolidKind::Box) {
        const Vec local = rotate(solid.turn, x - a, -1.0);
        const Vec nearest{std::clamp(local[0], -b[0], b[0]), std::clamp(local[1], -b[1], b[1]),
                          std::clamp(local[2], -b[2], b[2])};
        const Vec away = local - nearest;
        if (norm(away) > 0.0) {
            return {rotate(solid.turn, 1.0 / norm(away) * away, 1.0), norm(away)};
        }
        std::size_t face = 0;
        for (std::size_t i = 1; i < 3; ++i) {
            face = std::abs(local[i]) - b[i] > std::abs(local[face]) - b[face] ? i : face;
        }
        Vec normal{};
        normal[face] = local[face] < 0.0 ? -1.0 : 1.0;
        return {rotate(solid.turn, normal, 1.0), std::abs(local[face]) - b[face]};
    }
    Vec centre = a;
    if (solid.kind == SolidKind::Capsule) {
        centre = a + std::clamp(dot(x - a, b - a) / dot(b - a, b - a), 0.0, 1.0) * (b - a);
    }
    return {1.0 / norm(x - centre) * (x - centre), norm(x - centre) - double{solid.radius}};
}

// seen_reference.hpp, which needs what stands above.
[[nodiscard]] std::optional<Contact> touchingSeen(const SimulationSettings& s, const Vec& x);
[[nodiscard]] Vec keptInFront(const SimulationSettings& s, const Vec& x, const Vec& start);

using Bodies = std::vector<ReferenceBody>;

inline void push(ReferenceBody& body, const Vec& x, const Vec& by) {
    body.shift = body.shift + by;
    body.moment = body.moment + cross(x - body.centre, by);
}

/// The six faces of the domain, then the solids, then the bodies, then, of adhesion alone, what is seen.
inline std::vector<Contact> contacts(const SimulationSettings& s, const Bodies& bodies, const Vec& x, bool adhering) {
    std::vector<Contact> all;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec normal{};
        normal[axis] = 1.0;
        all.push_back({normal, x[axis] - double{s.low[axis]}});
        all.push_back({-1.0 * normal, double{s.high[axis]} - x[axis]});
    }
    for (const Solid& solid : s.solids) {
        all.push_back(touching(solid, x));
    }
    for (const ReferenceBody& body : bodies) {
        all.push_back(touching(body.solid, x));
    }
    if (const auto seen = s.seen && adhering ? touchingSeen(s, x) : std::nullopt; seen) {
        all.push_back(*seen);
    }
    return all;
}

/// `mass`: of the particle, which counts in what it gives a body.
inline Vec pushedOut(const SimulationSettings& s, Bodies& bodies, Vec x, const Vec& start, double mass) {
    const auto r = double{s.radius};
    for (const Solid& solid : s.solids) {
        const Contact contact = touching(solid, x);
        x = x + std::max(r - contact.distance, 0.0) * contact.normal;
    }
    for (ReferenceBody& body : bodies) {
        const Contact contact = touching(body.solid, x);
        const Vec by = std::max(r - contact.distance, 0.0) * contact.normal;
        push(body, x, mass * by);
        x = x + by;
    }
    x = keptInFront(s, x, start);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        x[axis] = std::clamp(x[axis], double{s.low[axis]} + r, double{s.high[axis]} - r);
    }
    return x;
}

/// Of all force fields, m/s^2.
inline Vec fieldsAt(const SimulationSettings& s, const Vec& x) {
    Vec sum{};
    for (const ForceField& field : s.sources.fields) {
        const Vec axis = 1.0 / norm(wide(field.axis)) * wide(field.axis);
        Vec away = x - wide(field.centre);
        if (field.kind == ForceKind::Vortex) {
            away = cross(cross(axis, away), axis);
        }
        const double q = field.radius > 0.0F ? norm(away) / double{field.radius} : 0.0;
        const double strength = q < 1.0 ? double{field.strength} * std::pow(1.0 - q * q, 2) : 0.0;
        const Vec along = field.kind == ForceKind::Wind    ? axis
                          : field.kind == ForceKind::Point ? -1.0 / norm(away) * away
                                                           : 1.0 / norm(away) * cross(axis, away);
        sum = sum + strength * along;
    }
    return sum;
}

struct Walls {
    Vec gradient{};
    double density = 0.0;
    std::vector<Vec> parts;  ///< of the gradient, of each wall
};

/// Integrals of the kernels over what lies behind each wall, by quadrature.
inline Walls wallsAt(const SimulationSettings& s, const Bodies& bodies, const Kernels& kernels, const Vec& x) {
    const double h = kernels.h;
    Walls walls;
    for (const Contact& contact : contacts(s, bodies, x, false)) {
        const double d = std::clamp(contact.distance, 0.0, h);
        const double share = kernels.wall * kernels.halfSpace(d);
        const double slope = kernels.halfSpaceSlope(d);
        walls.gradient = (1.0 - share) * walls.gradient - slope * (1.0 - walls.density) * contact.normal;
        for (Vec& part : walls.parts) {
            part = (1.0 - share) * part;
        }
        walls.parts.push_back(-slope * (1.0 - walls.density) * contact.normal);
        walls.density += share * (1.0 - walls.density);
    }
    return walls;
}

}  // namespace sluice::vk::test::reference
