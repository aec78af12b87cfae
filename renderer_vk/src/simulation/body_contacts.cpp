// SPDX-License-Identifier: MIT
#include "simulation/body_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace sluice::vk {
namespace {

constexpr int kRounds = 4;
constexpr double kBounce = 0.2;       ///< of the speed of an impact that is fast enough
constexpr double kBouncesFrom = 0.5;  ///< m/s: slower ones end it, so that a body comes to rest
constexpr double kFriction = 0.4;     ///< of the normal impulse

/// A ball of what touches: a corner has radius 0.
struct Probe {
    Vector centre;
    double radius;
};

std::vector<Probe> probesOf(const Body& body, const BodyState& state) {
    const Vector h = wide(body.half);
    std::vector<Probe> probes;
    if (body.shape == SolidKind::Box) {
        for (unsigned corner = 0; corner < 8; ++corner) {
            const Vector at{(corner & 1U) != 0 ? h[0] : -h[0], (corner & 2U) != 0 ? h[1] : -h[1],
                            (corner & 4U) != 0 ? h[2] : -h[2]};
            probes.push_back({plus(state.centre, turned(state.turn, at)), 0.0});
        }
        return probes;
    }
    const Vector up = turned(state.turn, {0, h[1] - h[0], 0});
    probes.push_back({minus(state.centre, up), h[0]});
    if (body.shape == SolidKind::Capsule) {
        probes.push_back({plus(state.centre, up), h[0]});
    }
    return probes;
}

/// The point of a sphere's or capsule's axis that is nearest to `to`.
Probe nearestOf(const Solid& solid, const Vector& to) {
    const Vector a = wide(solid.a);
    if (solid.kind != SolidKind::Capsule) {
        return {a, double{solid.radius}};
    }
    const Vector axis = minus(wide(solid.b), a);
    const double square = dot(axis, axis);
    const double along = square > 0.0 ? std::clamp(dot(minus(to, a), axis) / square, 0.0, 1.0) : 0.0;
    return {plus(a, times(along, axis)), double{solid.radius}};
}

/// One side of a contact. Without a body it is as heavy as the world.
struct Side {
    const Body* body = nullptr;
    BodyState* state = nullptr;

    [[nodiscard]] bool free() const { return body != nullptr && body->free(); }
    [[nodiscard]] double mass() const { return double{body->density} * bodyVolume(*body); }
    [[nodiscard]] Vector velocityAt(const Vector& x) const {
        return body == nullptr ? Vector{} : plus(state->velocity, cross(state->spin, minus(x, state->centre)));
    }
    /// How much an impulse along `n` at `x` changes the speed there.
    [[nodiscard]] double give(const Vector& x, const Vector& n) const {
        if (!free()) {
            return 0.0;
        }
        const Vector arm = minus(x, state->centre);
        return (1.0 + dot(n, cross(spinOf(*body, *state, cross(arm, n)), arm))) / mass();
    }
    void push(const Vector& x, const Vector& impulse) const {
        if (free()) {
            const Vector arm = minus(x, state->centre);
            state->velocity = plus(state->velocity, times(1.0 / mass(), impulse));
            state->spin = plus(state->spin, spinOf(*body, *state, times(1.0 / mass(), cross(arm, impulse))));
        }
    }
};

/// `n` points from `b` to `a`, which overlap by `depth` at `x`.
void meet(const Side& a, const Side& b, const Vector& x, const Vector& n, double depth) {
    const double light_a = a.free() ? 1.0 / a.mass() : 0.0;
    const double light_b = b.free() ? 1.0 / b.mass() : 0.0;
    if (depth <= 0.0 || light_a + light_b == 0.0) {
        return;
    }
    if (a.free()) {
        a.state->centre = plus(a.state->centre, times(depth * light_a / (light_a + light_b), n));
    }
    if (b.free()) {
        b.state->centre = minus(b.state->centre, times(depth * light_b / (light_a + light_b), n));
    }
    const Vector meeting = minus(a.velocityAt(x), b.velocityAt(x));
    const double speed = dot(meeting, n);
    if (speed >= 0.0) {
        return;
    }
    const double bounce = speed < -kBouncesFrom ? kBounce : 0.0;
    const double normal = -(1.0 + bounce) * speed / (a.give(x, n) + b.give(x, n));
    Vector impulse = times(normal, n);
    const Vector sliding = minus(meeting, times(speed, n));
    if (length(sliding) > 1e-9) {
        const Vector along = unit(sliding);
        const double stop = length(sliding) / (a.give(x, along) + b.give(x, along));
        impulse = minus(impulse, times(std::min(stop, kFriction * normal), along));
    }
    a.push(x, impulse);
    b.push(x, times(-1.0, impulse));
}

void meetSolid(const Side& a, const Side& b, const Solid& solid) {
    for (const Probe& probe : probesOf(*a.body, *a.state)) {
        const SolidContact contact = contactWith(solid, probe.centre);
        meet(a, b, minus(probe.centre, times(probe.radius, contact.normal)), contact.normal,
             probe.radius - contact.distance);
    }
    // What is round reaches a face between the corners.
    if (a.body->shape != SolidKind::Sphere && (solid.kind == SolidKind::Sphere || solid.kind == SolidKind::Capsule)) {
        const Probe probe = nearestOf(solid, a.state->centre);
        const SolidContact contact = contactWith(solidOf(*a.body, *a.state), probe.centre);
        meet(a, b, minus(probe.centre, times(probe.radius, contact.normal)), times(-1.0, contact.normal),
             probe.radius - contact.distance);
    }
}

}  // namespace

Vector spinOf(const Body& body, const BodyState& state, const Vector& momentum) {
    const Vector inertia = inertiaOverMass(body);
    Vector own = turnedBack(state.turn, momentum);
    for (std::size_t i = 0; i < 3; ++i) {
        own.at(i) /= inertia.at(i);
    }
    return turned(state.turn, own);
}

void resolveContacts(std::span<const Body> bodies, std::span<BodyState> states, std::span<const Solid> walls) {
    for (int round = 0; round < kRounds; ++round) {
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            const Side a{&bodies[i], &states[i]};
            for (std::size_t j = 0; j < bodies.size(); ++j) {
                if (i != j) {
                    meetSolid(a, {&bodies[j], &states[j]}, solidOf(bodies[j], states[j]));
                }
            }
            for (const Solid& wall : walls) {
                if (a.free()) {
                    meetSolid(a, {}, wall);
                }
            }
        }
    }
}

}  // namespace sluice::vk
