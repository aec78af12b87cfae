// SPDX-License-Identifier: MIT
#include "sluice/particles/generate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "waves.hpp"

namespace sluice::particles {

namespace {

/// A lattice site or a drop: its random numbers depend on what it is, not on what came before it, so that a particle
/// keeps its jitter from frame to frame.
struct Site {
    std::int64_t i, k, q;
    std::uint64_t family;  ///< pool, ball or crown
};

/// The output function of SplitMix64 (Steele, Lea, Flood: "Fast splittable pseudorandom number generators", 2014).
std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
}

/// Uniform in [-1,1), 53 bits, exact.
double random(std::uint64_t seed, const Site& site, std::uint64_t which) {
    constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;
    std::uint64_t state = seed;
    for (const std::uint64_t part : {static_cast<std::uint64_t>(site.i), static_cast<std::uint64_t>(site.k),
                                     static_cast<std::uint64_t>(site.q), site.family, which}) {
        state = mix(state + kGolden + part);
    }
    return static_cast<double>(state >> 11U) * 0x1p-52 - 1.0;
}

constexpr double kJitter = 0.2;  // of a radius
constexpr std::uint64_t kPool = 1;
constexpr std::uint64_t kBall = 2;
constexpr std::uint64_t kCrown = 3;

using Point = std::array<double, 3>;
/// Receives a particle's position and velocity.
using Emit = std::function<void(const Point&, const Point&)>;

struct Lattice {
    double radius;
    double spacing;
    std::int64_t columns;  ///< per side
    double first;          ///< coordinate of the first column; the columns are centred in [-1,1]
};

Lattice latticeFor(double radius) {
    const double spacing = 2.0 * radius;
    const auto columns = static_cast<std::int64_t>(std::floor(2.0 / spacing));
    return {radius, spacing, columns, -0.5 * static_cast<double>(columns - 1) * spacing};
}

/// How many particles hang below a surface of this height: none lower than r above the floor.
std::int64_t columnSize(double height, const Lattice& lattice) {
    return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(height / lattice.spacing)));
}

void emitPool(const Lattice& lattice, std::uint64_t seed, double time, const Emit& emit) {
    const double jitter = kJitter * lattice.radius;
    for (std::int64_t i = 0; i < lattice.columns; ++i) {
        for (std::int64_t k = 0; k < lattice.columns; ++k) {
            const Site column{i, k, -1, kPool};
            // Rounded here, so that the surface is met at the very coordinates that the file holds.
            const auto x = static_cast<double>(static_cast<float>(
                lattice.first + static_cast<double>(i) * lattice.spacing + jitter * random(seed, column, 0)));
            const auto z = static_cast<double>(static_cast<float>(
                lattice.first + static_cast<double>(k) * lattice.spacing + jitter * random(seed, column, 1)));
            const double height = poolHeight(x, z, time);
            const Point velocity{0.0, poolHeightRate(x, z, time), 0.0};
            const std::int64_t size = columnSize(height, lattice);
            for (std::int64_t q = 0; q < size; ++q) {
                const Site site{i, k, q, kPool};
                const double y = height - lattice.radius - static_cast<double>(q) * lattice.spacing;
                // The topmost particle stands straight under the surface; the others shift, lest rows show through.
                const double shift = q == 0 ? 0.0 : jitter;
                emit({x + shift * random(seed, site, 0), y + shift * random(seed, site, 1),
                      z + shift * random(seed, site, 2)},
                     velocity);
            }
        }
    }
}

void emitBall(const Lattice& lattice, std::uint64_t seed, double time, const Emit& emit) {
    const PoolBall ball = poolBall(time);
    if (ball.centre[1] + ball.radius < 0.0) {
        return;
    }
    const double jitter = kJitter * lattice.radius;
    const double inside = ball.radius - lattice.radius;
    const auto most = static_cast<std::int64_t>(std::floor(ball.radius / lattice.spacing)) + 1;
    for (std::int64_t i = -most; i <= most; ++i) {
        for (std::int64_t q = -most; q <= most; ++q) {
            for (std::int64_t k = -most; k <= most; ++k) {
                const Site site{i, k, q, kBall};
                const Point at{static_cast<double>(i) * lattice.spacing, static_cast<double>(q) * lattice.spacing,
                               static_cast<double>(k) * lattice.spacing};
                if (at[0] * at[0] + at[1] * at[1] + at[2] * at[2] > inside * inside) {
                    continue;
                }
                const Point position{ball.centre[0] + at[0] + jitter * random(seed, site, 0),
                                     ball.centre[1] + at[1] + jitter * random(seed, site, 1),
                                     ball.centre[2] + at[2] + jitter * random(seed, site, 2)};
                if (position[1] > poolHeight(position[0], position[2], time)) {
                    emit(position, {0.0, ball.velocity_y, 0.0});
                }
            }
        }
    }
}

/// Drops leave the rim of the ball within kCrownDuration after the impact and fly freely until they are below the water
/// again. As many as one in fifty of the target; chosen from
/// pictures of the sample, nothing was measured.
void emitCrown(const Lattice& lattice, std::uint64_t seed, double time, std::size_t target, const Emit& emit) {
    constexpr double kCrownDuration = 0.22;  // s
    constexpr double kRim = 0.85;            // of the ball's radius
    const auto drops = static_cast<std::int64_t>(target / 50);
    for (std::int64_t drop = 0; drop < drops; ++drop) {
        const Site site{drop, 0, 0, kCrown};
        const double born = poolImpactTime() + kCrownDuration * 0.5 * (1.0 + random(seed, site, 0));
        const double since = time - born;
        if (since < 0.0) {
            continue;
        }
        const double angle = kPi * random(seed, site, 1);
        const Point outward{plainCos(angle), 0.0, plainSin(angle)};
        const double rim = kRim * kBallRadius + lattice.radius * random(seed, site, 2);
        const double out_speed = 0.75 + 0.2 * random(seed, site, 3);
        const double up_speed = 2.3 + 0.9 * random(seed, site, 4);
        const double x0 = kBallX + rim * outward[0];
        const double z0 = kBallZ + rim * outward[2];
        const Point position{x0 + out_speed * since * outward[0],
                             poolHeight(x0, z0, born) + up_speed * since - 0.5 * kGravity * since * since,
                             z0 + out_speed * since * outward[2]};
        const bool in_basin = std::abs(position[0]) <= 1.0 && std::abs(position[2]) <= 1.0;
        if (in_basin && position[1] > poolHeight(position[0], position[2], time)) {
            emit(position, {out_speed * outward[0], up_speed - kGravity * since, out_speed * outward[2]});
        }
    }
}

std::size_t countAtRest(double radius) {
    const Lattice lattice = latticeFor(radius);
    std::size_t count = 0;
    const Emit add = [&count](const Point&, const Point&) { ++count; };
    for (std::int64_t i = 0; i < lattice.columns; ++i) {
        for (std::int64_t k = 0; k < lattice.columns; ++k) {
            const double x = lattice.first + static_cast<double>(i) * lattice.spacing;
            const double z = lattice.first + static_cast<double>(k) * lattice.spacing;
            count += static_cast<std::size_t>(columnSize(poolHeight(x, z, 0.0), lattice));
        }
    }
    emitBall(lattice, 0, 0.0, add);
    return count;
}

/// The float radius whose lattice comes closest to the target at time 0, by bisection.
float radiusFor(std::size_t target) {
    double low = 1e-3;
    double high = 0.2;
    double best = high;
    std::size_t best_miss = target;
    for (int step = 0; step < 28; ++step) {
        const auto radius = static_cast<double>(static_cast<float>(0.5 * (low + high)));
        const std::size_t count = countAtRest(radius);
        const std::size_t miss = count > target ? count - target : target - count;
        if (miss < best_miss) {
            best = radius;
            best_miss = miss;
        }
        (count > target ? low : high) = radius;
    }
    return static_cast<float>(best);
}

void append(std::vector<float>& out, const Point& point) {
    for (const double value : point) {
        out.push_back(static_cast<float>(value));
    }
}

}  // namespace

Result<ParticleSet> generatePool(std::size_t target_count, std::uint64_t seed, double time_seconds) {
    if (target_count < kPoolFewest || target_count > kPoolMost) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "generated pool",
                     fmt::format("expected {} to {} particles, found {}", kPoolFewest, kPoolMost, target_count), ""};
    }
    if (!(time_seconds >= 0.0 && time_seconds <= kPoolLatest)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "generated pool",
                     fmt::format("expected a time from 0 to {} s, found {}", kPoolLatest, time_seconds), ""};
    }
    ParticleSet set;
    set.radius = radiusFor(target_count);
    const Lattice lattice = latticeFor(static_cast<double>(set.radius));
    set.position.reserve(3 * target_count + target_count / 4);
    set.velocity.reserve(3 * target_count + target_count / 4);
    const Emit emit = [&set](const Point& position, const Point& velocity) {
        append(set.position, position);
        append(set.velocity, velocity);
    };
    emitPool(lattice, seed, time_seconds, emit);
    emitBall(lattice, seed, time_seconds, emit);
    emitCrown(lattice, seed, time_seconds, target_count, emit);
    return set;
}

}  // namespace sluice::particles
