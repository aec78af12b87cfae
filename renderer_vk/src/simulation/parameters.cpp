// SPDX-License-Identifier: MIT
#include "simulation/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace sluice::vk {
namespace {

std::array<float, 4> with(const Triple& v, float w) {
    return {v[0], v[1], v[2], w};
}

SolidBlock blockOf(const Solid& solid) {
    return {with(solid.a, static_cast<float>(solid.kind)), with(solid.b, solid.radius), solid.turn};
}

/// 315 / (64 pi h^9), of poly6 (Mueller 2003, eq. 20).
double poly6Factor(double h) {
    return 315.0 / (64.0 * std::numbers::pi * std::pow(h, 9));
}

/// The bracket of poly6 summed over a cubic lattice of spacing 2r about one of its points, from the layer `first` on.
double latticeSum(double radius, int first) {
    const double h = 4.0 * radius;
    double sum = 0.0;
    for (int x = first; x <= 2; ++x) {
        for (int y = -2; y <= 2; ++y) {
            for (int z = -2; z <= 2; ++z) {
                const double square = 4.0 * radius * radius * (x * x + y * y + z * z);
                sum += std::pow(std::max(h * h - square, 0.0), 3);
            }
        }
    }
    return sum;
}

std::uint32_t powerOfTwo(double cells) {
    std::uint32_t power = 4;  // three rows must be three different ones
    while (static_cast<double>(power) < cells && power < kMostCells) {
        power *= 2;
    }
    return power;
}

}  // namespace

Grid planGrid(const SimulationSettings& settings, std::uint32_t particles) {
    std::array<double, 3> extent{};
    for (std::size_t i = 0; i < 3; ++i) {
        extent[i] = double{settings.high[i]} - double{settings.low[i]};
    }
    Grid grid;
    // (x - low) / side is computed in floats: two particles less than a support apart must not come to lie two cells
    // apart. Each of three roundings is at most 2^-24 of the extent, for two particles; eight of them leave room.
    grid.side = double{settings.support()} + *std::max_element(extent.begin(), extent.end()) * 0x1p-21;
    // checkSettings keeps x below 50,003 cells, so that the smallest table, x by 4 by 4, is within kMostCells.
    grid.x = static_cast<std::uint32_t>(std::ceil(extent[0] / grid.side)) + 2;
    grid.y = powerOfTwo(std::ceil(extent[1] / grid.side) + 2.0);
    grid.z = powerOfTwo(std::ceil(extent[2] / grid.side) + 2.0);
    const auto enough = std::clamp<std::uint64_t>(std::uint64_t{8} * particles, 1U << 16, kMostCells);
    while (std::uint64_t{grid.x} * grid.y * grid.z > enough && (grid.y > 4 || grid.z > 4)) {
        (grid.y > grid.z ? grid.y : grid.z) /= 2;
    }
    return grid;
}

double particleVolume(double radius) {
    return 1.0 / (poly6Factor(4.0 * radius) * latticeSum(radius, -2));
}

double wallFactor() {
    constexpr double kRadius = 0.25;  // h = 1; the factor is the same for all
    // halfSpace(0.25) of solids.glsl.
    constexpr double q = kRadius;
    constexpr double s = q * q;
    constexpr double kHalfSpace =
        0.5 - 315.0 / 256.0 * q * (1.0 + s * (-4.0 / 3.0 + s * (6.0 / 5.0 + s * (-4.0 / 7.0 + s / 9.0))));
    return (1.0 - latticeSum(kRadius, 0) / latticeSum(kRadius, -2)) / kHalfSpace;
}

double halfSpaceAdhesion(double q) {
    // Shells of radius s, of which the directions within acos(q / s) of the normal lie behind the plane: their cosines
    // add up to pi (1 - q^2 / s^2). Midpoints, as the fourth root is steep at both ends.
    constexpr int kParts = 2000;
    const double from = std::max(q, 0.5);
    const double step = (1.0 - from) / kParts;
    double sum = 0.0;
    for (int i = 0; i < kParts; ++i) {
        const double s = from + (i + 0.5) * step;
        const double root = std::pow(std::max(-4.0 * s * s + 6.0 * s - 2.0, 0.0), 0.25);
        sum += 0.007 * root * std::numbers::pi * (s * s - q * q);
    }
    return sum * step;
}

Parameters parametersOf(const SimulationSettings& s, const Grid& grid, const StepCounts& counts, std::uint32_t stride,
                        std::uint32_t most, float dt, std::span<const BodyState> bodies) {
    const auto h = double{s.support()};
    const double volume = particleVolume(double{s.radius});
    // Distance at which the artificial pressure is k: 0.2 h (Macklin & Mueller 2013 give 0.1 to 0.3).
    const double tensile = std::pow(h * h - std::pow(0.2 * h, 2), 3);
    Parameters p{};
    p.gravity = with(s.gravity, dt);
    p.low = with(s.low, s.radius);
    p.high = with(s.high, s.support());
    p.kernel = {static_cast<float>(volume * poly6Factor(h)),
                static_cast<float>(-volume * 45.0 / (std::numbers::pi * std::pow(h, 6))),
                static_cast<float>(double{s.relaxation} / (h * h)), static_cast<float>(double{s.tensile} * h * h)};
    p.fluid = {s.viscosity, s.vorticity, static_cast<float>(1.0 / tensile), 1.0F / dt};
    p.search = {static_cast<float>(1.0 / grid.side), static_cast<float>(wallFactor()), 0, 0};
    if (s.kernel != DensityKernel::Poly6) {
        const DensityTerms terms = densityTerms(s.kernel);
        p.fluid[2] = static_cast<float>(1.0 / terms.tensile);
        p.constraint = {static_cast<float>(terms.centre), static_cast<float>(-terms.centre / (h * h)),
                        static_cast<float>(terms.wall), static_cast<float>(terms.wall_slope / h)};
    }
    p.count = {counts.living, stride, most, static_cast<std::uint32_t>(s.solids.size() + bodies.size())};
    p.change = {counts.entries, counts.births, counts.next_identity, static_cast<std::uint32_t>(s.solids.size())};
    p.grid = {grid.x, grid.y - 1, grid.z - 1, grid.cells()};
    for (std::size_t i = 0; i < s.fluids.size(); ++i) {
        p.fluids.at(i) = fluidBlock(s.fluids[i]);
    }
    if (!s.fluids.empty()) {
        // Artificial pressure is a pressure: the same for all, that of the lightest in a fluid of its own.
        const auto lightest = std::min_element(s.fluids.begin(), s.fluids.end(),
                                               [](const Fluid& a, const Fluid& b) { return a.density < b.density; });
        p.kernel[3] *= lightest->density;
    }
    if (s.tense()) {
        // Cohesion is an attraction of masses, those of a particle of water; its kernel's greatest value is 1 / (2 pi
        // h^3).
        const double peak = kRestDensity * volume / (2.0 * std::numbers::pi * std::pow(h, 3));
        p.surface = {static_cast<float>(double{s.tension} * peak), s.tension,
                     static_cast<float>(double{s.adhesion} * kRestDensity), s.adhesion > 0.0F ? 1.0F : 0.0F};
        if (!s.fluids.empty()) {  // those of strength 1; each fluid has its own
            p.surface = {static_cast<float>(peak), 1.0F, static_cast<float>(kRestDensity), 1.0F};
        }
        static const auto kAdhesion = [] {
            std::array<float, 20> table{};
            for (std::size_t i = 0; i < 16; ++i) {
                table.at(i) = static_cast<float>(halfSpaceAdhesion(static_cast<double>(i) / 16.0));
            }
            return table;
        }();
        p.adhesion = kAdhesion;
    }
    for (std::size_t i = 0; i < s.solids.size(); ++i) {
        p.solids.at(i) = blockOf(s.solids[i]);
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        p.solids.at(s.solids.size() + i) = blockOf(solidOf(s.bodies[i], bodies[i]));
    }
    return p;
}

BodyBlock bodyBlock(std::span<const Body> bodies, std::span<const BodyState> states) {
    BodyBlock block{};
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        block.body.at(i) = {with(narrow(states[i].centre), static_cast<float>(1.0 / bodyReach(bodies[i]))),
                            with(narrow(states[i].velocity), 0.0F), with(narrow(states[i].spin), 0.0F)};
    }
    return block;
}

BodyImpulse impulseOf(const BodyPush& push, const SimulationSettings& settings, const Body& body, double seconds) {
    Vector shift{};
    Vector moment{};
    for (std::size_t i = 0; i < 6; ++i) {
        const auto low = static_cast<double>(push.sums.at(i)[0]);
        const auto high = static_cast<double>(static_cast<std::int32_t>(push.sums.at(i)[1]));
        (i < 3 ? shift : moment).at(i % 3) = (high * 0x1p12 + low) * 0x1p-22 * double{settings.support()};
    }
    // A particle is what a cube of the lattice at rest holds. What pushed it one way was pushed the other.
    const double mass = -std::pow(2.0 * double{settings.radius}, 3) / seconds;
    return {times(mass, shift), times(mass * bodyReach(body), moment)};
}

}  // namespace sluice::vk
