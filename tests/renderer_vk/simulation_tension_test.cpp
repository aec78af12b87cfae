// SPDX-License-Identifier: MIT
// Surface tension and adhesion: one step against the reference, and what they make of a cube.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/simulation_reference.hpp"
#include "simulation_rig.hpp"

namespace sluice::vk::test {
namespace {

class SimulationTension : public SimulationTest {};

std::vector<Vec> wideAll(const std::vector<float>& triples) {
    std::vector<Vec> vectors(triples.size() / 3);
    for (std::size_t i = 0; i < triples.size(); ++i) {
        vectors[i / 3][i % 3] = double{triples[i]};
    }
    return vectors;
}

TEST_F(SimulationTension, OneStepMatchesTheDoublePrecisionReference) {
    SimulationSettings settings;
    settings.low = {0, 0, 0};
    settings.high = {0.9F, 1, 0.8F};
    settings.solids = {sphereSolid({0.36F, 0.1F, 0.1F}, 0.08F)};
    settings.tension = 1.0F;
    settings.adhesion = 2.0F;
    std::vector<float> positions;
    for (const std::vector<float> all = lattice({0.02F, 0.02F, 0.02F}, 9, 8, 8, 0.038F, 0.008F, 7);
         const Vec& x : wideAll(all)) {
        if (contactWith(settings.solids[0], x).distance > 0.015) {
            std::transform(x.begin(), x.end(), std::back_inserter(positions),
                           [](double v) { return static_cast<float>(v); });
        }
    }
    constexpr double kDt = 1.0 / 128.0;
    const auto solver = make(settings, positions);
    ASSERT_TRUE(solver->step(kDt).ok());
    const ReferenceState before{wideAll(positions), std::vector<Vec>(positions.size() / 3), {}};
    const ReferenceState expected = referenceStep(settings, before, kDt);
    SimulationSettings plain = settings;
    plain.tension = plain.adhesion = 0.0F;
    const ReferenceState without = referenceStep(plain, before, kDt);
    const std::vector<Vec> v = wideAll(solver->read().value().velocity);
    double off = 0.0;
    double strongest = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i) {
        off = std::max(off, length(minus(v[i], expected.velocity[i])));
        strongest = std::max(strongest, length(minus(expected.velocity[i], without.velocity[i])));
    }
    // What two of its forces make of a rounded position, and a table of 16 parts: a two-hundredth of the forces
    // themselves.
    EXPECT_GT(strongest, 0.05) << "m/s: the forces do something";
    EXPECT_LT(off, 0.005 * strongest);
}

/// Second moments of the positions about their mean, along the axes and along a diagonal, m^2.
std::array<double, 4> moments(const std::vector<Vec>& x) {
    Vec mean{};
    for (const Vec& at : x) {
        mean = plus(mean, times(1.0 / static_cast<double>(x.size()), at));
    }
    std::array<double, 4> sums{};
    for (const Vec& at : x) {
        const Vec d = minus(at, mean);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sums.at(axis) += d[axis] * d[axis] / static_cast<double>(x.size());
        }
        sums[3] += std::pow((d[0] + d[1] + d[2]) / std::sqrt(3.0), 2) / static_cast<double>(x.size());
    }
    return sums;
}

TEST_F(SimulationTension, ABrickOfWaterBecomesABall) {
    SimulationSettings settings;
    settings.gravity = {0, 0, 0};
    settings.low = {-1, -1, -1};
    settings.high = {1, 1, 1};
    settings.tension = 0.2F;
    settings.viscosity = 0.1F;
    const std::vector<float> positions = lattice({-0.2F, -0.12F, -0.12F}, 10, 6, 6, 0.04F, 0.001F, 2);
    const auto solver = make(settings, positions);
    const auto longest = [](const std::vector<Vec>& x) {
        double most = 0.0;
        for (const Vec& at : x) {
            most = std::max(most, length(at));
        }
        return most;
    };
    const auto before = moments(wideAll(positions));
    EXPECT_GT(before[0] / before[1], 2.0);
    ASSERT_TRUE(solver->advance(3.0, 1.0 / 100.0).ok());
    const ParticleState state = solver->read().value();
    const std::vector<Vec> x = wideAll(state.position);
    const auto after = moments(x);
    const auto [least, most] = std::minmax_element(after.begin(), after.end());
    RecordProperty("ratio", std::to_string(*most / *least));
    EXPECT_LT(*most / *least, 1.15) << "its moments are those of a ball";
    EXPECT_LT(longest(x), 0.75 * longest(wideAll(positions))) << "the corners have come in";
    Vec momentum{};
    for (const Vec& v : wideAll(state.velocity)) {
        momentum = plus(momentum, times(1.0 / static_cast<double>(x.size()), v));
    }
    // Of each step a position's rounding over dt, 3e-8 / 0.01 s, as if all had the same sign in ten steps.
    EXPECT_LT(length(momentum), 3e-5);
}

}  // namespace
}  // namespace sluice::vk::test
