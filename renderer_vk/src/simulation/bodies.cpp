// SPDX-License-Identifier: MIT
#include "simulation/bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/body_contacts.hpp"

namespace sluice::vk {
namespace {

std::array<double, 4> aboutY(double degrees) {
    const double half = degrees * std::numbers::pi / 360.0;
    return {0, std::sin(half), 0, std::cos(half)};
}

/// q turned by the small rotation spin * seconds, and unit again.
std::array<double, 4> turnedBy(const std::array<double, 4>& q, const Vector& spin, double seconds) {
    const double angle = length(spin) * seconds;
    const Vector axis = angle > 0.0 ? times(std::sin(angle / 2.0), unit(spin)) : Vector{};
    const double w = std::cos(angle / 2.0);
    const Vector v{q[0], q[1], q[2]};
    const Vector xyz = plus(plus(times(w, v), times(q[3], axis)), cross(axis, v));
    const double real = w * q[3] - dot(axis, v);
    const double norm = std::sqrt(dot(xyz, xyz) + real * real);
    return {xyz[0] / norm, xyz[1] / norm, xyz[2] / norm, real / norm};
}

PathPoint onPath(const std::vector<PathPoint>& path, double time) {
    const auto after =
        std::find_if(path.begin(), path.end(), [time](const PathPoint& point) { return double{point.time} > time; });
    if (after == path.begin() || after == path.end()) {
        return after == path.end() ? path.back() : path.front();
    }
    const PathPoint& a = *(after - 1);
    const auto share = static_cast<float>((time - double{a.time}) / (double{after->time} - double{a.time}));
    PathPoint between{static_cast<float>(time), a.centre,
                      a.turn_degrees + share * (after->turn_degrees - a.turn_degrees)};
    for (std::size_t i = 0; i < 3; ++i) {
        between.centre.at(i) += share * (after->centre.at(i) - a.centre.at(i));
    }
    return between;
}

void follow(const Body& body, BodyState& state, double time, double seconds) {
    const PathPoint to = onPath(body.path, time + seconds);
    const PathPoint from = onPath(body.path, time);
    state.velocity = times(1.0 / seconds, minus(wide(to.centre), wide(from.centre)));
    state.spin = {0, double{to.turn_degrees - from.turn_degrees} * std::numbers::pi / 180.0 / seconds, 0};
    state.centre = wide(to.centre);
    state.turn = aboutY(double{to.turn_degrees});
}

/// a after b, as turns.
std::array<double, 4> product(const std::array<double, 4>& a, const std::array<double, 4>& b) {
    const Vector u{a[0], a[1], a[2]};
    const Vector v{b[0], b[1], b[2]};
    const Vector xyz = plus(plus(times(a[3], v), times(b[3], u)), cross(u, v));
    return {xyz[0], xyz[1], xyz[2], a[3] * b[3] - dot(u, v)};
}

void followDrive(const Drive& drive, BodyState& state, double time, double seconds) {
    const double length_s = drive.to_time - drive.from_time;
    const double share = length_s > 0.0 ? (time + seconds - drive.from_time) / length_s : 2.0;
    const double before = length_s > 0.0 ? (time - drive.from_time) / length_s : 2.0;
    constexpr double kRound = 1e-9;
    if (before > 1.0 - kRound) {
        state.velocity = state.spin = {};
        return;
    }
    const bool there = share > 1.0 - kRound;  // to the bit, whatever the steps add up to
    const Vector centre = there ? drive.to : plus(drive.from, times(share, minus(drive.to, drive.from)));
    state.velocity = times(1.0 / seconds, minus(centre, state.centre));
    state.spin = drive.spin;
    state.centre = centre;
    state.turn = there ? drive.to_turn : turnedBy(drive.from_turn, drive.spin, share * length_s);
}

/// Without a torque the angular momentum stays, and the spin follows from how the body is turned.
void fly(const Body& body, BodyState& state, const Triple& gravity, double seconds) {
    const Vector inertia = inertiaOverMass(body);
    Vector own = turnedBack(state.turn, state.spin);
    for (std::size_t i = 0; i < 3; ++i) {
        own.at(i) *= inertia.at(i);
    }
    const Vector momentum = turned(state.turn, own);
    state.velocity = plus(state.velocity, times(seconds, wide(gravity)));
    state.centre = plus(state.centre, times(seconds, state.velocity));
    state.turn = turnedBy(state.turn, state.spin, seconds);
    state.spin = spinOf(body, state, momentum);
}

Error wrong(const std::string& thing, const std::string& expected, const std::string& found, const char* remedy = "") {
    return {SLUICE_ERROR_INVALID_ARGUMENT, thing, fmt::format("expected {}, found {}", expected, found), remedy};
}
std::string shown(const Triple& v) {
    return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]);
}
bool finite(const Triple& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

Status checkBody(const Body& body, const std::string& thing, const Triple& low, const Triple& high) {
    const Triple& h = body.half;
    if (!finite(h) || std::min({h[0], h[1], h[2]}) <= 0.0F) {
        return wrong(thing + ": half", "half extents > 0", shown(h));
    }
    const bool round = body.shape == SolidKind::Sphere
                           ? h[0] == h[1] && h[1] == h[2]
                           : body.shape != SolidKind::Capsule || (h[0] == h[2] && h[1] >= h[0]);
    if (!round) {
        return wrong(thing + ": half",
                     body.shape == SolidKind::Sphere ? "the radius of a sphere, three times"
                                                     : "the radius of a capsule, its half length, its radius",
                     shown(h));
    }
    if (!finite(body.velocity) || !finite(body.spin) || !std::isfinite(body.turn_degrees) ||
        !(body.density >= 1e-3F && body.density <= 1e3F)) {
        return wrong(thing, "finite numbers and a density in [0.001, 1000]", fmt::format("{}", body.density),
                     "density is in terms of the fluid's: 0.5 floats half under, 2 sinks");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(body.centre[axis] >= low[axis] && body.centre[axis] <= high[axis]) && body.free()) {
            return wrong(thing + ": centre", fmt::format("a centre in the domain, {} to {}", shown(low), shown(high)),
                         shown(body.centre), "move it into the box, or drive it instead of letting it float");
        }
    }
    for (std::size_t i = 0; i < body.path.size(); ++i) {
        const PathPoint& point = body.path[i];
        if (!finite(point.centre) || !std::isfinite(point.turn_degrees) ||
            !(point.time >= 0.0F && (i == 0 || point.time > body.path[i - 1].time))) {
            return wrong(thing + ": path", "a path of finite places at times that ascend from 0 or later",
                         fmt::format("{} s at {}", point.time, i));
        }
    }
    return {};
}

}  // namespace

double bodyVolume(const Body& body) {
    const Vector h = wide(body.half);
    if (body.shape == SolidKind::Box) {
        return 8.0 * h[0] * h[1] * h[2];
    }
    return std::numbers::pi * h[0] * h[0] * (4.0 / 3.0 * h[0] + 2.0 * (h[1] - h[0]));
}

Vector inertiaOverMass(const Body& body) {
    const Vector h = wide(body.half);
    if (body.shape == SolidKind::Box) {
        return {(h[1] * h[1] + h[2] * h[2]) / 3.0, (h[0] * h[0] + h[2] * h[2]) / 3.0,
                (h[0] * h[0] + h[1] * h[1]) / 3.0};
    }
    // A cylinder of half length l between two half balls, whose own centres are 3/8 r beyond its ends.
    const double r = h[0];
    const double l = h[1] - r;
    const double ball = 4.0 / 3.0 * r / (4.0 / 3.0 * r + 2.0 * l);
    const double tube = 1.0 - ball;
    const double across = tube * (r * r / 4.0 + l * l / 3.0) + ball * (0.4 * r * r + l * l + 0.75 * l * r);
    return {across, tube * r * r / 2.0 + ball * 0.4 * r * r, across};
}

double bodyReach(const Body& body) {
    return body.shape == SolidKind::Box ? length(wide(body.half)) : double{body.half[1]};
}

BodyState startOf(const Body& body) {
    BodyState state;
    state.centre = wide(body.path.empty() ? body.centre : body.path.front().centre);
    state.turn = aboutY(double{body.path.empty() ? body.turn_degrees : body.path.front().turn_degrees});
    if (body.free()) {
        state.velocity = wide(body.velocity);
        state.spin = wide(body.spin);
    }
    return state;
}

Solid solidOf(const Body& body, const BodyState& state) {
    Solid solid;
    solid.kind = body.shape;
    solid.a = narrow(state.centre);
    solid.radius = body.half[0];
    if (body.shape == SolidKind::Capsule) {
        const Vector up = turned(state.turn, {0, double{body.half[1]} - double{body.half[0]}, 0});
        solid.a = narrow(minus(state.centre, up));
        solid.b = narrow(plus(state.centre, up));
    }
    if (body.shape == SolidKind::Box) {
        solid.b = body.half;
        solid.radius = 0.0F;
        for (std::size_t i = 0; i < 4; ++i) {
            solid.turn.at(i) = static_cast<float>(state.turn.at(i));
        }
    }
    return solid;
}

double fastestPoint(std::span<const Body> bodies, std::span<const BodyState> states) {
    double most = 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        most = std::max(most, length(states[i].velocity) + length(states[i].spin) * bodyReach(bodies[i]));
        for (std::size_t k = 1; k < bodies[i].path.size(); ++k) {
            const PathPoint& from = bodies[i].path[k - 1];
            const PathPoint& to = bodies[i].path[k];
            const double turn =
                std::abs(double{to.turn_degrees} - double{from.turn_degrees}) * std::numbers::pi / 180.0;
            const double way = length(minus(wide(to.centre), wide(from.centre))) + turn * bodyReach(bodies[i]);
            most = std::max(most, way / (double{to.time} - double{from.time}));
        }
    }
    return most;
}

std::vector<BodyState> movedBodies(std::span<const Body> bodies, std::span<const BodyState> states,
                                   std::span<const Solid> walls, const Triple& gravity, double time, double seconds) {
    std::vector<BodyState> moved(states.begin(), states.end());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i].free()) {
            fly(bodies[i], moved[i], gravity, seconds);
        } else if (bodies[i].driven) {
            followDrive(bodies[i].drive, moved[i], time, seconds);
        } else {
            follow(bodies[i], moved[i], time, seconds);
        }
    }
    resolveContacts(bodies, moved, walls);
    return moved;
}

Drive driveFrom(const BodyState& state, const Vector& centre, const std::array<double, 4>& turn, double time,
                double seconds) {
    Drive drive;
    drive.from_time = time;
    drive.to_time = time + seconds;
    drive.from = state.centre;
    drive.to = centre;
    drive.from_turn = state.turn;
    const double norm = std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]);
    for (std::size_t i = 0; i < 4; ++i) {
        drive.to_turn.at(i) = turn.at(i) / norm;
    }
    const std::array<double, 4>& q = state.turn;
    std::array<double, 4> way = product(drive.to_turn, {-q[0], -q[1], -q[2], q[3]});
    if (way[3] < 0.0) {
        std::transform(way.begin(), way.end(), way.begin(), [](double part) { return -part; });  // the shorter one
    }
    const Vector axis{way[0], way[1], way[2]};
    const double sine = length(axis);
    if (sine > 0.0) {
        drive.spin = times(2.0 * std::atan2(sine, way[3]) / (sine * seconds), axis);
    }
    return drive;
}

void pushBody(const Body& body, BodyState& state, const Vector& impulse, const Vector& twist, double seconds) {
    state.force = times(kRestDensity / seconds, impulse);
    state.torque = times(kRestDensity / seconds, twist);
    if (body.free()) {
        const double mass = double{body.density} * bodyVolume(body);
        state.velocity = plus(state.velocity, times(1.0 / mass, impulse));
        state.spin = plus(state.spin, spinOf(body, state, times(1.0 / mass, twist)));
    }
}

Status checkBodies(std::span<const Body> bodies, const Triple& low, const Triple& high) {
    if (bodies.size() > kMaxBodies) {
        return wrong("simulation: bodies", fmt::format("at most {}", kMaxBodies), fmt::format("{}", bodies.size()),
                     "leave some out");
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (Status status = checkBody(bodies[i], fmt::format("simulation: body {}", i), low, high); !status) {
            return status;
        }
    }
    return {};
}

}  // namespace sluice::vk
