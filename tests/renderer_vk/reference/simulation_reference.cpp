// SPDX-License-Identifier: MIT
#include "reference/simulation_reference.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace sluice::vk::test {
namespace {

constexpr double kPi = std::numbers::pi;

Vec operator+(const Vec& a, const Vec& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec operator-(const Vec& a, const Vec& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec operator*(double s, const Vec& v) {
    return {s * v[0], s * v[1], s * v[2]};
}
double dot(const Vec& a, const Vec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double norm(const Vec& v) {
    return std::sqrt(dot(v, v));
}
Vec cross(const Vec& a, const Vec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec wide(const Triple& v) {
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

struct Kernels {
    double h, volume, wall;

    explicit Kernels(double radius) : h(4.0 * radius), volume(1.0), wall(1.0) {
        double sum = 0.0;
        double behind = 0.0;
        for (int i = 0; i < 125; ++i) {
            const Vec at{2.0 * radius * (i % 5 - 2), 2.0 * radius * (i / 5 % 5 - 2), 2.0 * radius * (i / 25 - 2)};
            sum += poly6(norm(at));
            behind += at[0] < 0.0 ? poly6(norm(at)) : 0.0;
        }
        volume = 1.0 / sum;
        wall = volume * behind / halfSpace(radius);
    }
    /// Over the plane at depth z poly6 integrates to pi/4 (h^2 - z^2)^4 times its factor.
    [[nodiscard]] double halfSpace(double distance) const {
        const double factor = 315.0 / (64.0 * kPi * std::pow(h, 9));
        return factor * integral(distance, h, [this](double z) { return kPi / 4.0 * std::pow(h * h - z * z, 4); });
    }
    [[nodiscard]] double poly6(double r) const {
        return r < h ? 315.0 / (64.0 * kPi * std::pow(h, 9)) * std::pow(h * h - r * r, 3) : 0.0;
    }
    /// Of spiky at `d`, with respect to d.
    [[nodiscard]] Vec gradient(const Vec& d) const {
        const double r = norm(d);
        return r < h && r > 0.0 ? -45.0 / (kPi * std::pow(h, 6)) * std::pow(h - r, 2) / r * d : Vec{};
    }
};

struct Contact {
    Vec normal;
    double distance;
};

Vec rotate(const std::array<float, 4>& q, const Vec& v, double sign) {
    const Vec u{sign * double{q[0]}, sign * double{q[1]}, sign * double{q[2]}};
    const double w = double{q[3]};
    return 2.0 * dot(u, v) * u + (w * w - dot(u, u)) * v + 2.0 * w * cross(u, v);
}

Contact touching(const Solid& solid, const Vec& x) {
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

using Bodies = std::vector<ReferenceBody>;

void push(ReferenceBody& body, const Vec& x, const Vec& by) {
    body.shift = body.shift + by;
    body.moment = body.moment + cross(x - body.centre, by);
}

/// The six faces of the domain, then the solids, then the bodies.
std::vector<Contact> contacts(const SimulationSettings& s, const Bodies& bodies, const Vec& x) {
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
    return all;
}

Vec pushedOut(const SimulationSettings& s, Bodies& bodies, Vec x) {
    const double r = double{s.radius};
    for (const Solid& solid : s.solids) {
        const Contact contact = touching(solid, x);
        x = x + std::max(r - contact.distance, 0.0) * contact.normal;
    }
    for (ReferenceBody& body : bodies) {
        const Contact contact = touching(body.solid, x);
        const Vec by = std::max(r - contact.distance, 0.0) * contact.normal;
        push(body, x, by);
        x = x + by;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        x[axis] = std::clamp(x[axis], double{s.low[axis]} + r, double{s.high[axis]} - r);
    }
    return x;
}

/// Of all force fields, m/s^2.
Vec fieldsAt(const SimulationSettings& s, const Vec& x) {
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
Walls wallsAt(const SimulationSettings& s, const Bodies& bodies, const Kernels& kernels, const Vec& x) {
    const double h = kernels.h;
    Walls walls;
    for (const Contact& contact : contacts(s, bodies, x)) {
        const double d = std::clamp(contact.distance, 0.0, h);
        const double share = kernels.wall * kernels.halfSpace(d);
        // The gradient of a half-space is spiky, 15 / (pi h^6) (h - r)^3, over the plane that bounds it.
        const double slope = 15.0 / (kPi * std::pow(h, 6)) *
                             integral(d, h, [h](double r) { return 2.0 * kPi * r * std::pow(h - r, 3); });
        walls.gradient = (1.0 - share) * walls.gradient - slope * (1.0 - walls.density) * contact.normal;
        for (Vec& part : walls.parts) {
            part = (1.0 - share) * part;
        }
        walls.parts.push_back(-slope * (1.0 - walls.density) * contact.normal);
        walls.density += share * (1.0 - walls.density);
    }
    return walls;
}

using Lists = std::vector<std::vector<std::size_t>>;

Lists allPairs(const std::vector<Vec>& x, double h) {
    Lists lists(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t j = 0; j < x.size(); ++j) {
            if (i != j && norm(x[i] - x[j]) < h) {
                lists[i].push_back(j);
            }
        }
    }
    return lists;
}

double densityAt(const std::vector<Vec>& x, const std::vector<std::size_t>& list, const Kernels& kernels,
                 const Walls& walls, std::size_t i) {
    double density = kernels.volume * kernels.poly6(0.0) + walls.density;
    for (const std::size_t j : list) {
        density += kernels.volume * kernels.poly6(norm(x[i] - x[j]));
    }
    return density;
}

void iterate(const SimulationSettings& s, Bodies& bodies, const Kernels& kernels, const Lists& lists,
             std::vector<Vec>& x) {
    const double h = kernels.h;
    std::vector<double> lambda(x.size());
    std::vector<Walls> walls(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        walls[i] = wallsAt(s, bodies, kernels, x[i]);
        Vec own = walls[i].gradient;
        double squares = 0.0;
        for (const std::size_t j : lists[i]) {
            const Vec gradient = kernels.volume * kernels.gradient(x[i] - x[j]);
            own = own + gradient;
            squares += dot(gradient, gradient);
        }
        const double excess = std::max(densityAt(x, lists[i], kernels, walls[i], i) - 1.0, 0.0);
        lambda[i] = -excess / (squares + dot(own, own) + double{s.relaxation} / (h * h));
    }
    std::vector<Vec> moved(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        Vec delta = lambda[i] * walls[i].gradient;
        for (const std::size_t j : lists[i]) {
            const Vec d = x[i] - x[j];
            const double ratio = kernels.poly6(norm(d)) / kernels.poly6(0.2 * h);
            const double artificial = -double{s.tensile} * h * h * std::pow(ratio, 4);
            delta = delta + (lambda[i] + lambda[j] + artificial) * kernels.volume * kernels.gradient(d);
        }
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            push(bodies[k], x[i], lambda[i] * walls[i].parts[walls[i].parts.size() - bodies.size() + k]);
        }
        moved[i] = pushedOut(s, bodies, x[i] + delta);
    }
    x = moved;
}

/// Akinci et al. 2013, with the density of rest 1000 and volumes of rest in the normals, m/s^2.
std::vector<Vec> surfaceForces(const SimulationSettings& s, const Bodies& bodies, const Kernels& kernels,
                               const Lists& lists, const std::vector<Vec>& x) {
    const double h = kernels.h;
    std::vector<Vec> pull(x.size());
    std::vector<Vec> normal(x.size());
    std::vector<double> density(x.size());
    if (s.tension <= 0.0F && s.adhesion <= 0.0F) {
        return pull;
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Walls walls = wallsAt(s, bodies, kernels, x[i]);
        density[i] = densityAt(x, lists[i], kernels, walls, i);
        normal[i] = h * walls.gradient;
        for (const std::size_t j : lists[i]) {
            normal[i] = normal[i] + h * kernels.volume * kernels.gradient(x[i] - x[j]);
        }
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (const std::size_t j : lists[i]) {
            const Vec d = x[i] - x[j];
            const double r = norm(d);
            const double bump = std::pow(h - r, 3) * std::pow(r, 3);
            const double shape = r > h / 2.0 ? bump : 2.0 * bump - std::pow(h, 6) / 64.0;
            const double cohesion = 32.0 / (kPi * std::pow(h, 9)) * shape;
            const Vec force = 1000.0 * kernels.volume * cohesion / r * d + (normal[i] - normal[j]);
            pull[i] = pull[i] - double{s.tension} * 2.0 / (density[i] + density[j]) * force;
        }
        for (const Contact& contact : contacts(s, bodies, x[i])) {
            const double d = std::clamp(contact.distance, 0.0, h);
            // Over the half-space behind the wall, in shells about the particle.
            const double sum = integral(std::max(d, h / 2.0), h, [&](double r) {
                const double root = std::pow(std::max(-4.0 * r * r / h + 6.0 * r - 2.0 * h, 0.0), 0.25);
                return 0.007 / std::pow(h, 3.25) * root * kPi * (r * r - d * d);
            });
            pull[i] = pull[i] - double{s.adhesion} * 1000.0 * sum * contact.normal;
        }
    }
    return pull;
}

}  // namespace

ReferenceState referenceStep(const SimulationSettings& s, const ReferenceState& before, double dt) {
    Bodies none;
    return referenceStep(s, before, dt, none);
}

ReferenceState referenceStep(const SimulationSettings& s, const ReferenceState& before, double dt,
                             std::vector<ReferenceBody>& bodies) {
    const Kernels kernels(double{s.radius});
    const std::size_t n = before.position.size();
    std::vector<Vec> x(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec pull = wide(s.gravity) + fieldsAt(s, before.position[i]);
        x[i] = pushedOut(s, bodies, before.position[i] + dt * (before.velocity[i] + dt * pull));
    }
    const Lists lists = allPairs(x, kernels.h);
    for (std::uint32_t k = 0; k < s.iterations; ++k) {
        iterate(s, bodies, kernels, lists, x);
    }
    std::vector<Vec> v(n);
    for (std::size_t i = 0; i < n; ++i) {
        v[i] = 1.0 / dt * (x[i] - before.position[i]);
    }
    std::vector<Vec> curl(n);
    for (std::size_t i = 0; i < n; ++i) {
        for (const std::size_t j : lists[i]) {
            curl[i] = curl[i] + kernels.volume * cross(v[j] - v[i], -1.0 * kernels.gradient(x[i] - x[j]));
        }
    }
    ReferenceState after{x, v, std::vector<double>(n)};
    const std::vector<Vec> pull = surfaceForces(s, bodies, kernels, lists, x);
    for (std::size_t i = 0; i < n; ++i) {
        Vec drift{};
        Vec eta{};
        for (const std::size_t j : lists[i]) {
            drift = drift + kernels.volume * kernels.poly6(norm(x[i] - x[j])) * (v[j] - v[i]);
            eta = eta + kernels.volume * norm(curl[j]) * kernels.gradient(x[i] - x[j]);
        }
        after.velocity[i] = v[i] + double{s.viscosity} * drift;
        for (ReferenceBody& body : bodies) {
            const double distance = std::max(touching(body.solid, x[i]).distance, 0.0);
            if (distance < kernels.h) {
                const Vec there = body.velocity + cross(body.spin, x[i] - body.centre);
                const Vec drag = double{s.viscosity} * kernels.wall * kernels.halfSpace(distance) * (there - v[i]);
                after.velocity[i] = after.velocity[i] + drag;
                push(body, x[i], dt * drag);
            }
        }
        if (s.vorticity > 0.0F && norm(eta) > 1e-6) {
            after.velocity[i] = after.velocity[i] + dt * double{s.vorticity} / norm(eta) * cross(eta, curl[i]);
        }
        after.velocity[i] = after.velocity[i] + dt * pull[i];
        after.density[i] = densityAt(x, lists[i], kernels, wallsAt(s, bodies, kernels, x[i]), i);
    }
    return after;
}

}  // namespace sluice::vk::test
