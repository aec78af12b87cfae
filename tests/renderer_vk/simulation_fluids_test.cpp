// SPDX-License-Identifier: MIT
// Several fluids: one step against the reference, and what fluids of different density must do among each other.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "reference/simulation_reference.hpp"
#include "simulation_rig.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

class SimulationFluids : public SimulationTest {
  protected:
    [[nodiscard]] std::unique_ptr<Solver> makeOf(const SimulationSettings& settings,
                                                 const std::vector<float>& positions,
                                                 const std::vector<float>& velocities,
                                                 const std::vector<std::uint32_t>& fluids) const {
        auto solver = make(settings, positions);
        const Status status = solver->setParticles(positions, velocities, fluids);
        EXPECT_TRUE(status.ok()) << status.error().message();
        return solver;
    }
};

double massOfParticle(const SimulationSettings& settings, std::uint32_t fluid) {
    return double{settings.fluids[fluid].density};
}

/// Of all particles, in masses of a particle of water.
Vec momentumOf(const SimulationSettings& settings, const ParticleState& state) {
    Vec sum{};
    for (std::size_t i = 0; i < state.velocity.size(); ++i) {
        sum[i % 3] += massOfParticle(settings, state.fluid[i / 3]) * double{state.velocity[i]};
    }
    return sum;
}

double meanHeight(const ParticleState& state, std::uint32_t fluid) {
    double sum = 0.0;
    double number = 0.0;
    for (std::size_t i = 0; i < state.fluid.size(); ++i) {
        if (state.fluid[i] == fluid) {
            sum += double{state.position[3 * i + 1]};
            number += 1.0;
        }
    }
    return sum / number;
}

class SimulationFluidsOf : public SimulationFluids, public ::testing::WithParamInterface<DensityKernel> {};
INSTANTIATE_TEST_SUITE_P(EachKernel, SimulationFluidsOf,
                         ::testing::Values(DensityKernel::Poly6, DensityKernel::Spline, DensityKernel::Wendland));

TEST_P(SimulationFluidsOf, OneStepMatchesTheDoublePrecisionReferenceWithItsImpulses) {
    SimulationSettings settings;
    settings.kernel = GetParam();
    settings.low = {0, 0, 0};
    settings.high = {0.9F, 1, 0.8F};
    settings.fluids = {{1.0F, 0.02F, 0.5F, 1.0F}, {0.5F, 0.3F, 0.2F, 0.0F}, {2.0F, 0.1F, 0.0F, 2.0F}};
    Body box;
    box.shape = SolidKind::Box;
    box.centre = {0.2F, 0.3F, 0.2F};
    box.half = {0.1F, 0.06F, 0.1F};
    box.density = 0.5F;
    box.velocity = {0, -1, 0.2F};
    settings.bodies = {box};
    std::vector<float> positions;
    std::vector<std::uint32_t> fluids;
    for (const Vec& x : vectorsOf(lattice({0.02F, 0.02F, 0.02F}, 9, 8, 8, 0.037F, 0.006F, 7))) {
        if (contactWith(solidOf(box, startOf(box)), x).distance > 0.005) {
            std::transform(x.begin(), x.end(), std::back_inserter(positions),
                           [](double v) { return static_cast<float>(v); });
            fluids.push_back(static_cast<std::uint32_t>(fluids.size() * 7 % 3));
        }
    }
    Dice dice(3);
    std::vector<float> velocities(positions.size());
    std::generate(velocities.begin(), velocities.end(), [&] { return dice.between(-1.0F, 1.0F); });
    constexpr double kDt = 1.0 / 256.0;
    const auto solver = makeOf(settings, positions, velocities, fluids);
    std::vector<BodyState> states(solver->bodies().begin(), solver->bodies().end());
    states = movedBodies(settings.bodies, states, {}, settings.gravity, 0.0, kDt);
    std::vector<ReferenceBody> bodies{
        {solidOf(settings.bodies[0], states[0]), states[0].centre, states[0].velocity, states[0].spin}};
    ASSERT_TRUE(solver->step(kDt).ok());
    const ReferenceState expected =
        referenceStep(settings, {vectorsOf(positions), vectorsOf(velocities), {}, fluids}, kDt, bodies);
    const ParticleState after = solver->read().value();
    EXPECT_EQ(after.fluid, fluids);
    const std::vector<Vec> x = vectorsOf(after.position);
    const std::vector<Vec> v = vectorsOf(after.velocity);
    double farthest = 0.0;
    double fastest = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        farthest = std::max(farthest, apart(x[i], expected.position[i]));
        fastest = std::max(fastest, apart(v[i], expected.velocity[i]));
    }
    RecordProperty("radii", std::to_string(farthest / double{settings.radius}));
    RecordProperty("speed", std::to_string(fastest * kDt / double{settings.radius}));
    EXPECT_LT(farthest, 5e-5 * double{settings.radius});
    // The bound of SimulationStep, and what a table of adhesion is off by.
    EXPECT_LT(fastest, 1e-4 * double{settings.radius} / kDt);
    EXPECT_GT(*std::max_element(expected.density.begin(), expected.density.end()), 1.02);
    const double mass = std::pow(2.0 * double{settings.radius}, 3) * kRestDensity / kDt / kDt;
    const double force = mass * length(bodies[0].shift);
    RecordProperty("force",
                   std::to_string(length(plus(solver->bodies()[0].force, times(mass, bodies[0].shift))) / force));
    EXPECT_GT(force, 1.0) << "N; the case is worth something";
    // Adhesion pulls the body too, which the reference does not count.
    EXPECT_LT(length(plus(solver->bodies()[0].force, times(mass, bodies[0].shift))), 0.02 * force);
}

TEST_F(SimulationFluids, MomentumOfTwoFluidsThatMeetIsKeptToRoundOff) {
    SimulationSettings settings;
    settings.gravity = {0, 0, 0};
    settings.low = {-4, -4, -4};
    settings.high = {4, 4, 4};
    settings.fluids = {{1.0F, 0.02F, 0.3F, 0.0F}, {0.25F, 0.2F, 0.1F, 0.0F}};
    const std::vector<float> positions = lattice({-0.2F, -0.2F, -0.2F}, 10, 10, 10, 0.038F, 0.006F, 2);
    std::vector<float> velocities(positions.size());
    std::vector<std::uint32_t> fluids(positions.size() / 3);
    for (std::size_t i = 0; i < fluids.size(); ++i) {
        fluids[i] = positions[3 * i] < 0.0F ? 0U : 1U;
        velocities[3 * i] = fluids[i] == 0 ? 0.6F : -0.6F;
    }
    const auto solver = makeOf(settings, positions, velocities, fluids);
    const Vec before = momentumOf(settings, solver->read().value());
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(solver->step(0.004).ok());
    }
    const ParticleState after = solver->read().value();
    double light = 0.0;
    for (std::size_t i = 0; i < fluids.size(); ++i) {
        light += fluids[i] == 1 ? double{after.velocity[3 * i]} + 0.6 : 0.0;
    }
    EXPECT_GT(light / static_cast<double>(fluids.size()), 0.2) << "m/s: it was hit";
    // As in SimulationPhysics: a position's rounding over dt, as if all had the same sign in a few steps.
    const double bound = 2.0 * 0x1p-24 / 0.004 * static_cast<double>(fluids.size());
    EXPECT_LT(length(minus(momentumOf(settings, after), before)), bound);
}

/// A column of 6 x 16 x 6, in a box of its own width.
struct Column {
    SimulationSettings settings;
    std::vector<float> positions;
    std::vector<std::uint32_t> fluids;
};
Column columnOf(std::vector<Fluid> kinds, bool lighter_below) {
    Column column;
    column.settings.low = {0, 0, 0};
    column.settings.high = {0.24F, 1.0F, 0.24F};
    column.settings.fluids = std::move(kinds);
    column.positions = lattice({0, 0, 0}, 6, 16, 6, 0.04F, 0.001F, 1);
    for (std::size_t i = 0; i < column.positions.size(); i += 3) {
        column.fluids.push_back((column.positions[i + 1] < 0.32F) == lighter_below ? 1U : 0U);
    }
    return column;
}

TEST_F(SimulationFluids, OilRisesThroughWaterAndTheVolumeStays) {
    const Column column = columnOf({{1.0F}, {0.25F}}, true);
    const auto solver = makeOf(column.settings, column.positions, {}, column.fluids);
    EXPECT_LT(meanHeight(solver->read().value(), 1), 0.17) << "the oil begins below";
    const auto report = solver->advance(3.0, 1.0 / 60.0);
    ASSERT_TRUE(report.ok()) << report.error().message();
    const ParticleState state = solver->read().value();
    const double oil = meanHeight(state, 1);
    const double water = meanHeight(state, 0);
    RecordProperty("oil", std::to_string(oil));
    RecordProperty("water", std::to_string(water));
    // Two layers of 0.32 m have their middles at 0.16 and 0.48 m; what is still on its way keeps them from it.
    EXPECT_GT(oil - water, 0.6 * 0.32);
    // Together they stand as one fluid does: twice the mean height is the height of the column, 0.64 m less what its
    // own weight takes of it.
    EXPECT_NEAR(oil + water, 0.64, 0.02);
    EXPECT_EQ(state.fluid, column.fluids);
}

TEST_F(SimulationFluids, AMixedColumnLiftsWhatIsInEachLayerByItsDensityAndTheFloorBearsBoth) {
    SimulationSettings settings;
    settings.low = {0, 0, 0};
    settings.high = {0.4F, 1.2F, 0.4F};
    settings.fluids = {{1.0F}, {0.25F}};
    const auto still = [](const Triple& centre, const Triple& half) {
        Body body;
        body.centre = centre;
        body.half = half;
        body.path = {{0.0F, centre, 0.0F}};
        return body;
    };
    settings.bodies = {still({0.2F, 0.28F, 0.2F}, {0.08F, 0.08F, 0.08F}),
                       still({0.2F, 0.68F, 0.2F}, {0.08F, 0.08F, 0.08F}),
                       still({0.2F, 0.02F, 0.2F}, {0.4F, 0.06F, 0.4F})};
    std::vector<float> positions;
    std::vector<std::uint32_t> fluids;
    double weight = 0.0;
    for (const Vec& x : vectorsOf(lattice({0, 0.08F, 0}, 10, 20, 10, 0.04F, 0.001F, 1))) {
        if (std::all_of(settings.bodies.begin(), settings.bodies.end(), [&](const Body& body) {
                return contactWith(solidOf(body, startOf(body)), x).distance > 0.015;
            })) {
            std::transform(x.begin(), x.end(), std::back_inserter(positions),
                           [](double v) { return static_cast<float>(v); });
            fluids.push_back(x[1] < 0.48 ? 0U : 1U);
            weight += massOfParticle(settings, fluids.back()) * std::pow(0.04, 3) * kRestDensity * 9.81;
        }
    }
    const auto solver = makeOf(settings, positions, {}, fluids);
    ASSERT_TRUE(solver->advance(0.6, 1.0 / 60.0).ok());
    std::array<double, 3> force{};
    solver->watchSteps([&](const StepReport& report, bool kept) {
        for (std::size_t i = 0; i < force.size(); ++i) {
            force.at(i) += kept ? solver->bodies()[i].force[1] * report.seconds / 0.6 : 0.0;
        }
        return true;
    });
    ASSERT_TRUE(solver->advance(0.6, 1.0 / 60.0).ok());
    const double lifted = std::pow(0.16, 3) * kRestDensity * 9.81;
    RecordProperty("low", std::to_string(force[0] / lifted));
    RecordProperty("high", std::to_string(force[1] / lifted));
    RecordProperty("floor", std::to_string(force[2] / weight));
    EXPECT_NEAR(force[0] / force[1], 4.0, 1.0);
    // Centres of particles keep a radius away, so that the water's own volume is between that of the box and of one
    // of 0.2 m.
    EXPECT_GT(force[0], 0.8 * lifted);
    EXPECT_LT(force[0], 1.25 * 1.25 * 1.25 * lifted);
    // The floor bears all that is not lifted off it: the water, and what the boxes press on it.
    EXPECT_NEAR((force[2] + force[0] + force[1]) / -weight, 1.0, 0.05);
}

TEST_F(SimulationFluids, OneFluidInTheListIsTheFluidOfTheSettingsToTheBit) {
    Column column = columnOf({{1.0F, 0.05F}}, true);
    std::fill(column.fluids.begin(), column.fluids.end(), 0U);
    SimulationSettings plain = column.settings;
    plain.fluids.clear();
    plain.viscosity = 0.05F;
    const auto listed = makeOf(column.settings, column.positions, {}, column.fluids);
    const auto bare = make(plain, column.positions);
    ASSERT_TRUE(listed->advance(0.1, 1.0 / 120.0).ok());
    ASSERT_TRUE(bare->advance(0.1, 1.0 / 120.0).ok());
    EXPECT_EQ(listed->read().value().position, bare->read().value().position);
    EXPECT_EQ(listed->read().value().velocity, bare->read().value().velocity);
    EXPECT_TRUE(bare->read().value().fluid.empty());
    // A density alone changes nothing of how a fluid moves: 2 and its inverse are exact.
    SimulationSettings heavy = column.settings;
    heavy.fluids[0].density = 2.0F;
    const auto other = makeOf(heavy, column.positions, {}, column.fluids);
    ASSERT_TRUE(other->advance(0.1, 1.0 / 120.0).ok());
    const std::vector<Vec> a = vectorsOf(other->read().value().position);
    const std::vector<Vec> b = vectorsOf(bare->read().value().position);
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_LT(apart(a[i], b[i]), 1e-3 * double{plain.radius}) << i;
    }
}

TEST_F(SimulationFluids, AnEmitterGivesItsOwnFluid) {
    SimulationSettings settings;
    settings.low = {-0.5F, 0, -0.5F};
    settings.high = {0.5F, 1, 0.5F};
    settings.fluids = {{1.0F}, {0.5F}};
    Emitter tap;
    tap.centre = {0, 0.8F, 0};
    tap.width = tap.height = 0.12F;
    tap.speed = 2.0F;
    tap.fluid = 1;
    settings.sources.emitters = {tap};
    const std::vector<float> positions = lattice({-0.12F, 0, -0.12F}, 6, 3, 6, 0.04F, 0.0F, 1);
    const auto solver = make(settings, positions);
    const auto report = solver->advance(0.2, 1.0 / 60.0);
    ASSERT_TRUE(report.ok()) << report.error().message();
    const ParticleState state = solver->read().value();
    EXPECT_GT(report.value().born, 20U);
    EXPECT_EQ(static_cast<std::uint64_t>(std::count(state.fluid.begin(), state.fluid.end(), 1U)), report.value().born);
    EXPECT_EQ(std::count(state.fluid.begin(), state.fluid.end(), 0U), 108);
}

TEST_F(SimulationFluids, WhatIsOutOfRangeIsNamed) {
    const auto refused = [&](std::vector<Fluid> fluids, const char* words) {
        SimulationSettings settings;
        settings.fluids = std::move(fluids);
        const Status status = checkSettings(settings);
        ASSERT_FALSE(status.ok()) << words;
        EXPECT_THAT(status.error().message(), HasSubstr(words));
    };
    refused(std::vector<Fluid>(9), "simulation: fluids: expected at most 8, found 9");
    refused({{1.0F}, {1.0F, 2.0F}}, "fluid 1: viscosity");
    refused({{0.0F}}, "fluid 0: density");
    refused({{1.0F}, {0.05F}}, "1 and 0.05, 20 times");
    SimulationSettings settings;
    settings.fluids = {{1.0F}, {0.5F}};
    const std::vector<float> positions = lattice({-0.9F, 0.1F, -0.9F}, 2, 1, 1, 0.04F, 0.0F, 1);
    const auto solver = make(settings, positions);
    EXPECT_THAT(solver->setParticles(positions, {}, std::vector<std::uint32_t>{0, 2}).error().message(),
                HasSubstr("particle 1: expected a fluid below 2, found 2"));
    EXPECT_THAT(solver->setParticles(positions, {}, std::vector<std::uint32_t>{0}).error().message(),
                HasSubstr("a fluid for each of 2 or for none"));
}

}  // namespace
}  // namespace sluice::vk::test
