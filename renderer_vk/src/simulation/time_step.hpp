// SPDX-License-Identifier: MIT
// How long a step may be: the CFL rule. Pure.
#pragma once

#include <cstdint>

namespace sluice::vk {

struct StepLimits {
    double longest = 1.0 / 60.0;  ///< seconds, whatever the speed
    double reach = 0.0;           ///< metres that a particle may fly in one step
    double acceleration = 0.0;    ///< m/s^2, of gravity
};

/// Of one call of Solver::advance: what needs more is not going to end.
inline constexpr std::uint32_t kMostSteps = 4096;

/// The fastest that anything may be, m/s, for steps of `reach` metres to cover so many seconds.
[[nodiscard]] constexpr double fastestOf(double reach, double seconds) {
    return kMostSteps * reach / seconds;
}

/// The next step of what is `left` (seconds): the fewest equal parts of it that keep to the limits at `speed` (m/s).
[[nodiscard]] double nextStep(double left, double speed, const StepLimits& limits);

}  // namespace sluice::vk
