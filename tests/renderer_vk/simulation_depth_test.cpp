// SPDX-License-Identifier: MIT
// A step is held to the depth of the fluid: what happens without that, and how the depth is measured.
#include <algorithm>
#include <array>

#include "simulation_rig.hpp"

namespace sluice::vk::test {
namespace {

class SimulationDepth : public SimulationTest {};

/// Greatest energy of a fluid at rest within half a second, of that at first.
double rise(Solver& solver, double longest) {
    const double at_first = energyOf(solver.read().value());
    double highest = 0.0;
    for (int i = 0; i < 5; ++i) {
        const auto report = solver.advance(0.1, longest);
        EXPECT_TRUE(report.ok()) << report.error().message();
        highest = std::max(highest, energyOf(solver.read().value()));
    }
    return highest / at_first;
}

TEST_F(SimulationDepth, AColumnTooDeepForTheStepBoilsUnlessItsStepsAreHeldToItsDepth) {
    SimulationSettings settings;
    settings.low = {0, 0, 0};
    settings.high = {0.16F, 2.4F, 0.16F};
    const std::vector<float> positions = lattice({0, 0, 0}, 4, 40, 4, 0.04F, 0.0F, 1);
    EXPECT_LT(rise(*make(settings, positions), 1.0 / 60.0), 1.0);
    settings.overshoot = 0.0F;
    EXPECT_GT(rise(*make(settings, positions), 1.0 / 60.0), 1.05)
        << "nothing to hold a step to: this test shows nothing";
}

class SimulationDepthOf : public SimulationTest, public ::testing::WithParamInterface<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(EachNumberOfIterations, SimulationDepthOf, ::testing::Values(2U, 4U));

TEST_P(SimulationDepthOf, AColumnIsHeldByTheOtherKernelsToo) {
    for (const DensityKernel kernel : {DensityKernel::Spline, DensityKernel::Wendland}) {
        SimulationSettings settings;
        settings.kernel = kernel;
        settings.iterations = GetParam();
        settings.low = {0, 0, 0};
        settings.high = {0.16F, 2.4F, 0.16F};
        const std::vector<float> positions = lattice({0, 0, 0}, 4, 40, 4, 0.04F, 0.0F, 1);
        EXPECT_LT(rise(*make(settings, positions), 1.0 / 60.0), 1.0) << static_cast<int>(kernel);
    }
}

TEST_F(SimulationDepth, IsMeasuredAlongGravityWhicheverWayItPoints) {
    for (const std::size_t axis : {0U, 1U, 2U}) {
        SimulationSettings settings;
        settings.gravity = {1, -1, 1};
        settings.gravity.at(axis) = -9.0F;
        settings.low = {0, 0, 0};
        settings.high = {0.32F, 0.32F, 0.32F};
        settings.high.at(axis) = 3.0F;
        std::array<int, 3> number{8, 8, 8};
        number.at(axis) = 20;
        const std::vector<float> positions = lattice({0, 0, 0}, number[0], number[1], number[2], 0.04F, 0.0F, 1);
        const auto report = make(settings, positions)->step(0.001);
        ASSERT_TRUE(report.ok()) << report.error().message();
        // Two by two particles of a cell's width in each of 20 layers; a cell is a little wider than that.
        EXPECT_NEAR(report.value().depth, 0.8, 0.01) << axis;
        settings.overshoot = 0.0F;
        EXPECT_EQ(make(settings, positions)->step(0.001).value().depth, 0.0);
        settings.overshoot = 0.17F;
        settings.gravity = {0, 0, 0};
        EXPECT_EQ(make(settings, positions)->step(0.001).value().depth, 0.0);
    }
}

}  // namespace
}  // namespace sluice::vk::test
