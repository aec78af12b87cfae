// SPDX-License-Identifier: MIT
// Particle input that the project makes itself: a wavy pool in [-1,1]^2, a ball of liquid falling into it, the crown
// that it throws up and the rings that it leaves. Not a simulation: everything is an explicit function of time, so that
// the surface is known exactly and a picture can be measured against it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "sluice/particles/particles.hpp"
#include "sluice/result.hpp"

namespace sluice::particles {

/// Limits of generatePool's arguments.
inline constexpr std::size_t kPoolFewest = 1000;
inline constexpr std::size_t kPoolMost = 16'000'000;
inline constexpr double kPoolLatest = 60.0;  ///< seconds

/// Height of the water (metres) above the floor y = 0 at (x, z), x and z in [-1,1], at a time in [0, kPoolLatest]
/// seconds: a mean depth of 0.55, four travelling sines, and, once the ball has landed, rings that spread and die away.
/// The deep-water dispersion relation (w^2 = g k tanh(k d), Airy) gives each wave its speed, rounded to a constant.
[[nodiscard]] double poolHeight(double x, double z, double time);

/// The derivative of poolHeight with respect to time (m/s), exact.
[[nodiscard]] double poolHeightRate(double x, double z, double time);

/// The ball of liquid: free fall from rest at time 0. What of it is below the pool's surface has become pool.
struct PoolBall {
    std::array<double, 3> centre;  ///< metres
    double radius;                 ///< metres
    double velocity_y;             ///< m/s
};
[[nodiscard]] PoolBall poolBall(double time);

/// The moment at which the ball touches the mean surface, seconds.
[[nodiscard]] double poolImpactTime();

/// Particles on a jittered lattice of spacing 2r, with velocities and without colour. r depends on `target_count`
/// alone, so that a sequence keeps its radius; at time 0 the count is within 2 % of `target_count`, later it follows
/// the water. Columns of the lattice hang from the surface: the topmost particle of each is exactly r below poolHeight
/// at its (x, z), the others follow 2r apart, all moving with the surface's own speed. The seed moves the jitter only.
/// The same arguments give the same bits: no libm function but sqrt is used and no multiply-add is fused, which leaves
/// IEEE 754 nothing open. Seen with g++ 12 on x86-64; the fingerprints in generate_test.cpp, taken there, fail where a
/// compiler or processor gives others. An argument out of range is SLUICE_ERROR_INVALID_ARGUMENT.
[[nodiscard]] Result<ParticleSet> generatePool(std::size_t target_count, std::uint64_t seed, double time_seconds);

}  // namespace sluice::particles
