// SPDX-License-Identifier: MIT
// Sine and cosine from additions and multiplications only: the C library's may differ in the last bit between systems.
#pragma once

namespace sluice::particles {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kGravity = 9.80665;  ///< m/s^2, standard gravity (CGPM 1901)

/// sin(x) to within 1e-12 for |x| < 1e3.
[[nodiscard]] double plainSin(double x);
[[nodiscard]] double plainCos(double x);

/// Where the ball goes in, metres.
inline constexpr double kBallX = -0.15;
inline constexpr double kBallZ = 0.1;
inline constexpr double kBallY = 1.5;
inline constexpr double kBallRadius = 0.4;
inline constexpr double kMeanDepth = 0.55;

}  // namespace sluice::particles
