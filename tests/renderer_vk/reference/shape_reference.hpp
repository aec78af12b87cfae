// SPDX-License-Identifier: MIT
// The ellipsoid of a particle in double precision, from the formulas of docs/simulation.md. No code is shared with the
// pass: two passes over the neighbours, and axes by the largest entry's rotation until nothing is left to rotate.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "simulation/anisotropy.hpp"
#include "simulation/vector.hpp"

namespace sluice::vk::test {

using Matrix = std::array<Vector, 3>;

struct ReferenceEllipsoid {
    Vector centre{};
    Matrix stretch{};  ///< of a sphere
    Vector axes{};     ///< lengths, in no order
};

/// Rows of `axes` become the axes of the symmetric `m`, whose diagonal becomes the values along them.
inline void diagonalise(Matrix& m, Matrix& axes) {
    axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int round = 0; round < 64; ++round) {
        std::size_t p = 0;
        std::size_t q = 1;
        for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{0, 2}, {1, 2}}) {
            if (std::abs(m[a][b]) > std::abs(m[p][q])) {
                p = a;
                q = b;
            }
        }
        if (std::abs(m[p][q]) < 1e-18) {
            return;
        }
        const double angle = 0.5 * std::atan2(2.0 * m[p][q], m[p][p] - m[q][q]);
        const double c = std::cos(angle);
        const double s = std::sin(angle);
        for (std::size_t k = 0; k < 3; ++k) {  // columns, then rows
            const double a = m[k][p];
            const double b = m[k][q];
            m[k][p] = c * a + s * b;
            m[k][q] = c * b - s * a;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const double a = m[p][k];
            const double b = m[q][k];
            m[p][k] = c * a + s * b;
            m[q][k] = c * b - s * a;
            const double u = axes[p][k];
            const double v = axes[q][k];
            axes[p][k] = c * u + s * v;
            axes[q][k] = c * v - s * u;
        }
    }
}

/// Of particle i, whose neighbours are `list`. h is the support.
inline ReferenceEllipsoid referenceEllipsoid(const std::vector<Vector>& x, std::size_t i,
                                             const std::vector<std::uint32_t>& list, double h, const Anisotropy& how) {
    const auto weightOf = [&](std::size_t j) {
        const double q = std::hypot(x[j][0] - x[i][0], x[j][1] - x[i][1], x[j][2] - x[i][2]) / h;
        return q < 1.0 ? 1.0 - q * q * q : 0.0;
    };
    double neighbours = 0.0;
    Vector mean = x[i];
    for (const std::uint32_t j : list) {
        neighbours += weightOf(j);
        for (std::size_t k = 0; k < 3; ++k) {
            mean[k] += weightOf(j) * x[j][k];
        }
    }
    for (double& value : mean) {
        value /= neighbours + 1.0;
    }
    // What a lattice of spacing h/2 has, and half a particle's weight of that belief.
    double lattice_weights = 0.0;
    double lattice_squares = 0.0;
    for (int cell = 0; cell < 125; ++cell) {
        const int at[3] = {cell % 5 - 2, cell / 5 % 5 - 2, cell / 25 - 2};
        const double a[3] = {0.5 * at[0], 0.5 * at[1], 0.5 * at[2]};
        const double weight = std::max(1.0 - std::pow(std::hypot(a[0], a[1], a[2]), 3), 0.0);
        lattice_weights += weight;
        lattice_squares += weight * a[0] * a[0];
    }
    Matrix spread{};
    const auto add = [&](std::size_t j, double weight) {
        for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t b = 0; b < 3; ++b) {
                spread[a][b] += weight * (x[j][a] - mean[a]) * (x[j][b] - mean[b]) / (h * h);
            }
        }
    };
    add(i, 1.0);
    for (const std::uint32_t j : list) {
        add(j, weightOf(j));
    }
    for (std::size_t a = 0; a < 3; ++a) {
        spread[a][a] += 0.5 * lattice_squares / lattice_weights;
        for (double& value : spread[a]) {
            value /= neighbours + 1.5;
        }
    }
    Matrix axes{};
    diagonalise(spread, axes);
    ReferenceEllipsoid made;
    double longest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        made.axes[k] = std::sqrt(spread[k][k]);
        longest = std::max(longest, made.axes[k]);
    }
    double volume = 1.0;
    for (double& axis : made.axes) {
        axis = std::max(axis, longest / double{how.ratio});
        volume *= axis;
    }
    const double t = std::min(neighbours / 3.0, 1.0);
    const double size = double{how.lonely} + (1.0 - double{how.lonely}) * t * t * (3.0 - 2.0 * t);
    for (double& axis : made.axes) {
        axis *= size / std::cbrt(volume);
    }
    for (std::size_t a = 0; a < 3; ++a) {
        made.centre[a] = x[i][a] + double{how.smoothing} * (mean[a] - x[i][a]);
        for (std::size_t b = 0; b < 3; ++b) {
            for (std::size_t k = 0; k < 3; ++k) {
                made.stretch[a][b] += made.axes[k] * axes[k][a] * axes[k][b];
            }
        }
    }
    return made;
}

}  // namespace sluice::vk::test
