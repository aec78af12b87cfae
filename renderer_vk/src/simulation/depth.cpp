// SPDX-License-Identifier: MIT
#include "simulation/depth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sluice::vk {
namespace {

double spacing(const SimulationSettings& settings) {
    return 2.0 * double{settings.radius};
}

/// How much weight the iterations carry, those of poly6 as the measure. The other kernels answer a push more stiffly: a
/// single iteration goes too far however short the step, two may do so a little. docs/results/simulation.md has where.
double worthOfIterations(const SimulationSettings& settings) {
    return settings.kernel == DensityKernel::Poly6 ? settings.iterations : 0.5 * (settings.iterations - 1.0);
}

}  // namespace

double gravityOf(const SimulationSettings& settings) {
    return std::hypot(double{settings.gravity[0]}, double{settings.gravity[1]}, double{settings.gravity[2]});
}

bool heldToDepth(const SimulationSettings& settings) {
    return settings.overshoot > 0.0F && gravityOf(settings) > 0.0;
}

std::uint32_t deepestAxis(const SimulationSettings& settings) {
    std::uint32_t axis = 1;  // of two alike, up and down
    for (const std::uint32_t other : {0U, 2U}) {
        axis = std::abs(settings.gravity.at(other)) > std::abs(settings.gravity.at(axis)) ? other : axis;
    }
    return axis;
}

double depthOf(const SimulationSettings& settings, const Grid& grid, std::uint32_t particles) {
    double area = 1.0;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        if (axis != deepestAxis(settings)) {  // a domain may be narrower than a cell
            area *= std::min(grid.side, double{settings.high.at(axis)} - double{settings.low.at(axis)});
        }
    }
    const double d = spacing(settings);
    return static_cast<double>(particles) * d * d * d / area;
}

double longestAtDepth(const SimulationSettings& settings, double depth) {
    if (!heldToDepth(settings) || !(depth > 0.0)) {
        return std::numeric_limits<double>::infinity();
    }
    const double d = spacing(settings);
    // Light fluid below heavy bears the weight of so much more of its own.
    const double heaviest = depth * densityRatio(settings.fluids);
    return d * std::sqrt(double{settings.overshoot} * worthOfIterations(settings) / (gravityOf(settings) * heaviest));
}

}  // namespace sluice::vk
