// SPDX-License-Identifier: MIT
// Rigid bodies that push the fluid and are pushed by it. Pure: no Vulkan type. Masses are in m^3 of fluid at rest.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simulation/solid.hpp"
#include "simulation/vector.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Where a body that goes its own way is at one time; in between, straight on.
struct PathPoint {
    float time = 0.0F;  ///< s, ascending
    Triple centre{};
    float turn_degrees = 0.0F;  ///< about +y
};
/// Where a driven body goes from one time to another, straight on; before and after, it rests.
struct Drive {
    double from_time = 0.0, to_time = 0.0;  ///< s
    Vector from{}, to{};
    std::array<double, 4> from_turn{0, 0, 0, 1}, to_turn{0, 0, 0, 1};  ///< unit quaternions
    Vector spin{};                                                     ///< that turns the one into the other, rad/s
};
/// As it is at the start.
struct Body {
    SolidKind shape = SolidKind::Box;  ///< not a plane; a capsule stands upright
    Triple centre{};
    Triple half{};  ///< of the box around it: a sphere's radius three times, a capsule's radius, half length with caps,
                    ///< radius
    float turn_degrees = 0.0F;  ///< about +y
    float density = 1.0F;       ///< of water at rest
    Triple velocity{};          ///< m/s
    Triple spin{};              ///< rad/s
    std::vector<PathPoint>
        path{};           ///< if there is one, nothing stops the body; density, velocity and spin mean nothing then
    bool driven = false;  ///< likewise; it goes where `drive` says
    Drive drive{};

    /// Whether fluid, gravity and impacts move it.
    [[nodiscard]] bool free() const { return path.empty() && !driven; }
};
inline constexpr std::size_t kMaxBodies = 16;
/// kg/m^3, so that forces can be said in newtons.
inline constexpr double kRestDensity = 1000.0;

/// A body during the simulation.
struct BodyState {
    Vector centre{}, velocity{}, spin{};
    std::array<double, 4> turn{0, 0, 0, 1};  ///< unit quaternion from its axes to the world's
    Vector force{}, torque{};                ///< of the fluid in the last step, N and N m, about the centre
};

[[nodiscard]] double bodyVolume(const Body& body);
/// Principal moments of inertia over the mass, m^2.
[[nodiscard]] Vector inertiaOverMass(const Body& body);
/// Farthest point of its surface from its centre, m.
[[nodiscard]] double bodyReach(const Body& body);
[[nodiscard]] BodyState startOf(const Body& body);
/// The body as something that fluid stays out of.
[[nodiscard]] Solid solidOf(const Body& body, const BodyState& state);
/// Of the fastest point of any of them, m/s; of one with a path, the fastest that it will ever be: it may start at any
/// time.
[[nodiscard]] double fastestPoint(std::span<const Body> bodies, std::span<const BodyState> states);

/// All of them `seconds` later without fluid: gravity, paths, and impacts on each other and on `walls`.
[[nodiscard]] std::vector<BodyState> movedBodies(std::span<const Body> bodies, std::span<const BodyState> states,
                                                 std::span<const Solid> walls, const Triple& gravity, double time,
                                                 double seconds);
/// From where it is at `time` to another place in so many seconds. `turn`: of any length but 0.
[[nodiscard]] Drive driveFrom(const BodyState& state, const Vector& centre, const std::array<double, 4>& turn,
                              double time, double seconds);
/// Gives a body what the fluid gave it in a step: linear and angular momentum, m^3 m/s and m^3 m^2/s.
void pushBody(const Body& body, BodyState& state, const Vector& impulse, const Vector& twist, double seconds);

/// The first that is out of its range, named.
[[nodiscard]] Status checkBodies(std::span<const Body> bodies, const Triple& low, const Triple& high);

}  // namespace sluice::vk
