// SPDX-License-Identifier: MIT
// How long a step may be: the CFL rule. Pure.
#pragma once

namespace sluice::vk {

struct StepLimits {
    double longest = 1.0 / 60.0;  ///< seconds, whatever the speed
    double reach = 0.0;           ///< metres that a particle may fly in one step
    double acceleration = 0.0;    ///< m/s^2, of gravity
};

/// The next step of what is `left` (seconds): the fewest equal parts of it that keep to the limits at `speed` (m/s).
[[nodiscard]] double nextStep(double left, double speed, const StepLimits& limits);

}  // namespace sluice::vk
