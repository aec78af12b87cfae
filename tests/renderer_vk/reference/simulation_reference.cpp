// SPDX-License-Identifier: MIT
#include "reference/simulation_reference.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "reference/seen_reference.hpp"
#include "reference/simulation_terms.hpp"

namespace sluice::vk::test {
namespace {

using namespace reference;

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
    double density = kernels.volume * kernels.value(0.0) + walls.density;
    for (const std::size_t j : list) {
        density += kernels.volume * kernels.value(norm(x[i] - x[j]));
    }
    return density;
}

/// Of every particle.
std::vector<Fluid> fluidsOf(const SimulationSettings& s, const ReferenceState& state) {
    const Fluid one{1.0F, s.viscosity, s.tension, s.adhesion};
    std::vector<Fluid> all(state.position.size(), s.fluids.empty() ? one : s.fluids[0]);
    for (std::size_t i = 0; i < state.fluid.size(); ++i) {
        all[i] = s.fluids[state.fluid[i]];
    }
    return all;
}

/// In units of a particle of water.
double mass(const Fluid& fluid) {
    return double{fluid.density};
}

void iterate(const SimulationSettings& s, const std::vector<Fluid>& fluids, Bodies& bodies, const Kernels& kernels,
             const Lists& lists, std::vector<Vec>& x, const std::vector<Vec>& start) {
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
            squares += dot(gradient, gradient) / mass(fluids[j]);
        }
        const double excess = std::max(densityAt(x, lists[i], kernels, walls[i], i) - 1.0, 0.0);
        const double relaxed = dot(own, own) + double{s.relaxation} / (h * h);
        lambda[i] = -excess / (squares + relaxed / mass(fluids[i]));
    }
    double lightest = 1e300;
    for (const Fluid& fluid : s.fluids) {
        lightest = std::min(lightest, mass(fluid));
    }
    lightest = s.fluids.empty() ? 1.0 : lightest;
    std::vector<Vec> moved(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        Vec delta = lambda[i] * walls[i].gradient;
        for (const std::size_t j : lists[i]) {
            const Vec d = x[i] - x[j];
            const double ratio = kernels.value(norm(d)) / kernels.value(0.2 * h);
            const double artificial = -double{s.tensile} * lightest * h * h * std::pow(ratio, 4);
            delta = delta + (lambda[i] + lambda[j] + artificial) * kernels.volume * kernels.gradient(d);
        }
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            push(bodies[k], x[i], lambda[i] * walls[i].parts[walls[i].parts.size() - bodies.size() + k]);
        }
        moved[i] = pushedOut(s, bodies, x[i] + 1.0 / mass(fluids[i]) * delta, start[i], mass(fluids[i]));
    }
    x = moved;
}

/// Akinci et al. 2013, with the density of rest 1000 and volumes of rest in the normals, m/s^2.
std::vector<Vec> surfaceForces(const SimulationSettings& s, const std::vector<Fluid>& fluids, const Bodies& bodies,
                               const Kernels& kernels, const Lists& lists, const std::vector<Vec>& x) {
    const double h = kernels.h;
    std::vector<Vec> pull(x.size());
    std::vector<Vec> normal(x.size());
    std::vector<double> density(x.size());
    if (!s.tense()) {
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
            // Newton's third law: the two masses' mean over the own.
            const double gamma = std::sqrt(double{fluids[i].tension} * double{fluids[j].tension}) * 2.0 *
                                 mass(fluids[j]) / (mass(fluids[i]) + mass(fluids[j]));
            pull[i] = pull[i] - gamma * 2.0 / (density[i] + density[j]) * force;
        }
        for (const Contact& contact : contacts(s, bodies, x[i], true)) {
            const double d = std::clamp(contact.distance, 0.0, h);
            // Over the half-space behind the wall, in shells about the particle.
            const double sum = integral(std::max(d, h / 2.0), h, [&](double r) {
                const double root = std::pow(std::max(-4.0 * r * r / h + 6.0 * r - 2.0 * h, 0.0), 0.25);
                return 0.007 / std::pow(h, 3.25) * root * kPi * (r * r - d * d);
            });
            pull[i] = pull[i] - double{fluids[i].adhesion} * 1000.0 * sum * contact.normal;
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
    const std::vector<Fluid> fluids = fluidsOf(s, before);
    std::vector<Vec> x(n);
    std::vector<Vec> start(n);
    for (std::size_t i = 0; i < n; ++i) {
        start[i] = rescued(s, before.position[i]);
        const Vec pull = wide(s.gravity) + fieldsAt(s, start[i]);
        x[i] = pushedOut(s, bodies, start[i] + dt * (before.velocity[i] + dt * pull), start[i], mass(fluids[i]));
    }
    const Kernels constraint(double{s.radius}, s.kernel);
    const Lists lists = allPairs(x, kernels.h);
    for (std::uint32_t k = 0; k < s.iterations; ++k) {
        iterate(s, fluids, bodies, constraint, lists, x, start);
    }
    std::vector<Vec> v(n);
    for (std::size_t i = 0; i < n; ++i) {
        v[i] = 1.0 / dt * (x[i] - start[i]);
    }
    std::vector<Vec> curl(n);
    for (std::size_t i = 0; i < n; ++i) {
        for (const std::size_t j : lists[i]) {
            curl[i] = curl[i] + kernels.volume * cross(v[j] - v[i], -1.0 * kernels.gradient(x[i] - x[j]));
        }
    }
    ReferenceState after{x, v, std::vector<double>(n), before.fluid};
    const std::vector<Vec> pull = surfaceForces(s, fluids, bodies, kernels, lists, x);
    for (std::size_t i = 0; i < n; ++i) {
        Vec drift{};
        Vec eta{};
        for (const std::size_t j : lists[i]) {
            const double rub = (double{fluids[i].viscosity} + double{fluids[j].viscosity}) / 2.0;
            const double share = 2.0 * mass(fluids[j]) / (mass(fluids[i]) + mass(fluids[j]));
            drift = drift + rub * share * kernels.volume * kernels.value(norm(x[i] - x[j])) * (v[j] - v[i]);
            eta = eta + kernels.volume * norm(curl[j]) * kernels.gradient(x[i] - x[j]);
        }
        after.velocity[i] = v[i] + drift;
        for (ReferenceBody& body : bodies) {
            const double distance = std::max(touching(body.solid, x[i]).distance, 0.0);
            if (distance < kernels.h) {
                const Vec there = body.velocity + cross(body.spin, x[i] - body.centre);
                const Vec drag =
                    double{fluids[i].viscosity} * kernels.wall * kernels.halfSpace(distance) * (there - v[i]);
                after.velocity[i] = after.velocity[i] + drag;
                push(body, x[i], mass(fluids[i]) * dt * drag);
            }
        }
        if (s.vorticity > 0.0F && norm(eta) > 1e-6) {
            after.velocity[i] = after.velocity[i] + dt * double{s.vorticity} / norm(eta) * cross(eta, curl[i]);
        }
        after.velocity[i] = after.velocity[i] + dt * pull[i];
        after.density[i] = densityAt(x, lists[i], constraint, wallsAt(s, bodies, constraint, x[i]), i);
    }
    return after;
}

}  // namespace sluice::vk::test
