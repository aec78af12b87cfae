// SPDX-License-Identifier: MIT
#include "simulation/time_step.hpp"

#include <algorithm>
#include <cmath>

namespace sluice::vk {

double nextStep(double left, double speed, const StepLimits& limits) {
    // speed dt + acceleration dt^2 = reach; this form of the root has no difference of nearly equal numbers.
    const double root = speed + std::sqrt(speed * speed + 4.0 * limits.acceleration * limits.reach);
    const double stable = root > 0.0 ? 2.0 * limits.reach / root : limits.longest;
    const double most = std::min(limits.longest, stable);
    // A part in 10^9 is rounding, and no reason for one step more.
    const double parts = std::max(1.0, std::ceil(left / most - 1e-9));
    return left / parts;
}

}  // namespace sluice::vk
