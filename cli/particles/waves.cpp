// SPDX-License-Identifier: MIT
#include "waves.hpp"

#include <array>
#include <cmath>

#include "sluice/particles/generate.hpp"

namespace sluice::particles {

namespace {

/// One travelling sine a sin(kx x + kz z - w t + phase).
struct Wave {
    double amplitude;  ///< metres
    double kx;         ///< 1/m
    double kz;
    double omega;  ///< 1/s, sqrt(g k tanh(k d)) for d = 0.55 m, rounded to two decimals
    double phase;
};
// Long swell with two shorter crossing waves. Their slopes add up to at most 0.61, so that the tops of lattice columns
// beside each other, 2r apart, still overlap when drawn with 1.5 r.
constexpr std::array<Wave, 4> kWaves{{{0.085, 2.2, 0.9, 4.49, 0.4},
                                      {0.060, -1.3, 2.7, 5.22, 1.9},
                                      {0.022, 4.6, -3.1, 7.36, 0.7},
                                      {0.012, 6.5, 5.2, 9.03, 2.6}}};

// The ring: a packet of compact support around a circle that widens with speed kRingSpeed and fades.
constexpr double kRingSpeed = 1.1;       // m/s, about the group speed of 0.8 m waves
constexpr double kRingAmplitude = 0.05;  // m
constexpr double kRingHalfWidth = 0.32;  // m
constexpr double kRingFade = 1.6;        // 1/s

struct HeightAndRate {
    double height = 0.0;
    double rate = 0.0;
};

/// a/(1+f t) (1-u^2)^3 (1 - 9 u^2) with u = (rho - c t)/w: continuous in value and slope at |u| = 1. The last factor
/// lets the trough weigh up the crest across the ring's width: the integral over u from -1 to 1 of (1-u^2)^3 (1-9u^2)
/// is 0.
HeightAndRate ring(double x, double z, double time) {
    const double since = time - poolImpactTime();
    if (since <= 0.0) {
        return {};
    }
    const double dx = x - kBallX;
    const double dz = z - kBallZ;
    const double u = (std::sqrt(dx * dx + dz * dz) - kRingSpeed * since) / kRingHalfWidth;
    const double v = 1.0 - u * u;
    if (v <= 0.0) {
        return {};
    }
    // The ring grows out of nothing within its first kRise seconds; a jump would tear the velocities.
    constexpr double kRise = 0.15;
    const double ramp = since < kRise ? since / kRise : 1.0;
    const double fade = 1.0 / (1.0 + kRingFade * since);
    const double amplitude = kRingAmplitude * ramp * fade;
    const double amplitude_rate =
        kRingAmplitude * ((since < kRise ? fade / kRise : 0.0) - ramp * kRingFade * fade * fade);
    const double shape = v * v * v * (1.0 - 9.0 * u * u);
    const double shape_by_u = -6.0 * u * v * v * (1.0 - 9.0 * u * u) - 18.0 * u * v * v * v;
    return {amplitude * shape, amplitude_rate * shape - amplitude * shape_by_u * kRingSpeed / kRingHalfWidth};
}

}  // namespace

double plainSin(double x) {
    // To [-pi, pi], then to [-pi/2, pi/2] by symmetry, then Taylor to x^19, whose remainder there is below 1e-15. The
    // bound in the header is for the rounding of the reduction, which grows with |x|.
    const double turns = std::floor(x / (2.0 * kPi) + 0.5);
    double r = x - turns * (2.0 * kPi);
    if (r > kPi / 2.0) {
        r = kPi - r;
    } else if (r < -kPi / 2.0) {
        r = -kPi - r;
    }
    const double s = r * r;
    double term = 1.0;
    for (int n = 18; n >= 2; n -= 2) {
        term = 1.0 - term * s / (static_cast<double>(n) * static_cast<double>(n + 1));
    }
    return r * term;
}

double plainCos(double x) {
    return plainSin(x + kPi / 2.0);
}

double poolImpactTime() {
    return std::sqrt(2.0 * (kBallY - kBallRadius - kMeanDepth) / kGravity);
}

double poolHeight(double x, double z, double time) {
    double height = kMeanDepth + ring(x, z, time).height;
    for (const Wave& wave : kWaves) {
        height += wave.amplitude * plainSin(wave.kx * x + wave.kz * z - wave.omega * time + wave.phase);
    }
    return height;
}

double poolHeightRate(double x, double z, double time) {
    double rate = ring(x, z, time).rate;
    for (const Wave& wave : kWaves) {
        rate -= wave.amplitude * wave.omega * plainCos(wave.kx * x + wave.kz * z - wave.omega * time + wave.phase);
    }
    return rate;
}

PoolBall poolBall(double time) {
    return {{kBallX, kBallY - 0.5 * kGravity * time * time, kBallZ}, kBallRadius, -kGravity * time};
}

}  // namespace sluice::particles
