// SPDX-License-Identifier: MIT
#include "simulation/density_kernel.hpp"

#include <algorithm>
#include <cmath>

namespace sluice::vk {
namespace {

/// Distances are in supports, as in density.glsl.
double shapeOf(DensityKernel kernel, double q) {
    const double a = std::max(1.0 - q, 0.0);
    if (kernel == DensityKernel::Spline) {
        const double b = std::max(0.5 - q, 0.0);
        return 2.0 * a * a * a - 8.0 * b * b * b;
    }
    return std::pow(a, 4) * (4.0 * q + 1.0);
}

/// Minus its derivative, over q.
double pullOf(DensityKernel kernel, double q) {
    const double a = std::max(1.0 - q, 0.0);
    if (kernel == DensityKernel::Spline) {
        return q < 0.5 ? 12.0 - 18.0 * q : 6.0 * a * a / q;
    }
    return 20.0 * a * a * a;
}

struct HalfSpace {
    double density, slope;
};
HalfSpace halfSpaceOf(DensityKernel kernel, double q) {
    const double a = 1.0 - q;
    if (kernel == DensityKernel::Spline) {
        const double b = std::max(0.5 - q, 0.0);
        return {std::pow(a, 5) * (1.6 - 16.0 / 15.0 * a) - std::pow(b, 5) * (3.2 - 64.0 / 15.0 * b),
                std::pow(a, 4) * (8.0 - 6.4 * a) - std::pow(b, 4) * (16.0 - 25.6 * b)};
    }
    return {std::pow(a, 6) * (3.5 + a * (-4.5 + 1.5 * a)), std::pow(a, 5) * (21.0 + a * (-31.5 + 12.0 * a))};
}

}  // namespace

DensityTerms densityTerms(DensityKernel kernel) {
    double all = 0.0;
    double behind = 0.0;
    double pull = 0.0;  // of those behind, along the normal
    for (int i = 0; i < 125; ++i) {
        const int cell[] = {i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2};
        const double x = 0.5 * cell[0];
        const double q = std::hypot(x, 0.5 * cell[1], 0.5 * cell[2]);
        const double shape = shapeOf(kernel, q);
        all += shape;
        if (x < 0.0) {
            behind += shape;
            pull -= x * pullOf(kernel, q);
        }
    }
    const HalfSpace wall = halfSpaceOf(kernel, 0.25);
    return {1.0 / all, shapeOf(kernel, 0.2), behind / all / wall.density, pull / all / wall.slope};
}

}  // namespace sluice::vk
