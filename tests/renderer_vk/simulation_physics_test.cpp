// SPDX-License-Identifier: MIT
// What a fluid must do over many steps: keep its momentum, its particles and its density, stay where it may be, come to
// rest, and do it all again bit for bit.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "simulation/parameters.hpp"
#include "simulation/time_step.hpp"
#include "simulation_rig.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

class SimulationPhysics : public SimulationTest {};

std::array<double, 3> sum(const std::vector<float>& triples) {
    std::array<double, 3> total{};
    for (std::size_t i = 0; i < triples.size(); ++i) {
        total[i % 3] += double{triples[i]};
    }
    return total;
}

TEST_F(SimulationPhysics, MomentumWithoutGravityIsKeptToRoundOff) {
    SimulationSettings settings;
    settings.gravity = {0, 0, 0};
    settings.low = {-4, -4, -4};
    settings.high = {4, 4, 4};
    // Pressed together, so that it bursts; a few in one place; far from the walls, which would take momentum.
    std::vector<float> positions = lattice({-0.2F, -0.2F, -0.2F}, 11, 11, 11, 0.037F, 0.008F, 2);
    std::copy_n(positions.begin(), 9, positions.begin() + 9);
    Dice dice(4);
    std::vector<float> velocities(positions.size());
    std::generate(velocities.begin(), velocities.end(), [&] { return dice.between(-0.5F, 0.8F); });
    const auto solver = make(settings, positions, velocities);
    double moved = 0.0;
    for (int i = 0; i < 10; ++i) {
        ASSERT_TRUE(solver->step(0.002).ok());
    }
    const auto after = solver->read();
    ASSERT_TRUE(after.ok());
    for (std::size_t i = 0; i < velocities.size(); ++i) {
        moved += std::abs(double{after.value().velocity[i]} - double{velocities[i]});
    }
    const std::array<double, 3> before_sum = sum(velocities);
    const std::array<double, 3> after_sum = sum(after.value().velocity);
    const double count = static_cast<double>(positions.size()) / 3.0;
    EXPECT_GT(moved / count, 0.1) << "nothing happened";
    // A step turns a position's rounding, half a unit of 2^-24 at 0.5 m, into a speed by dividing by dt; such errors of
    // many particles add up as a walk does, and are bounded here as if all had the same sign in one step of ten.
    const double bound = 0.5 * 0x1p-24 / 0.002;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_LT(std::abs(after_sum[axis] - before_sum[axis]) / count, bound) << axis;
    }
}

class SimulationPhysicsOf : public SimulationTest, public ::testing::WithParamInterface<DensityKernel> {};
INSTANTIATE_TEST_SUITE_P(EachKernel, SimulationPhysicsOf,
                         ::testing::Values(DensityKernel::Poly6, DensityKernel::Spline, DensityKernel::Wendland));

TEST_P(SimulationPhysicsOf, AColumnOfWaterSettlesWithoutGrowingAndHoldsItsDensity) {
    SimulationSettings settings;
    settings.kernel = GetParam();
    settings.low = {0, 0, 0};
    settings.high = {0.32F, 1.2F, 0.32F};
    const std::vector<float> positions = lattice({0, 0, 0}, 8, 20, 8, 0.04F, 0.0F, 1);
    const auto solver = make(settings, positions);
    const double at_first = energyOf(solver->read().value());
    double highest = 0.0;
    for (int i = 0; i < 10; ++i) {
        const auto report = solver->advance(0.1, 1.0 / 120.0);
        ASSERT_TRUE(report.ok()) << report.error().message();
        highest = std::max(highest, energyOf(solver->read().value()));
    }
    EXPECT_LT(highest, at_first) << "from rest a fluid has nothing to gain energy from";
    const auto state = solver->read();
    ASSERT_TRUE(state.ok());
    const double count = static_cast<double>(positions.size()) / 3.0;
    EXPECT_LT(std::sqrt(squares(state.value().velocity) / count), 0.1) << "it has come to rest, m/s";
    const auto densities = solver->densities();
    ASSERT_TRUE(densities.ok());
    double over = 0.0;
    float most = 0.0F;
    for (const float density : densities.value()) {
        ASSERT_TRUE(std::isfinite(density));
        over += std::max(0.0, double{density} - 1.0);
        most = std::max(most, density);
    }
    EXPECT_LT(over / count, 0.02);
    EXPECT_LT(most, 1.1F);
    EXPECT_EQ(state.value().position.size(), positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        ASSERT_GE(state.value().position[i], settings.low[i % 3] + settings.radius * 0.9999F);
        ASSERT_LE(state.value().position[i], settings.high[i % 3] - settings.radius * 0.9999F);
    }
}

/// A reading of Martin & Moyce 1952, tables 2 and 6: columns of ratio n^2 = 2, a = 2.25 inches.
struct Reading {
    double time;   ///< front: t sqrt(2 g / a); height: t sqrt(g / a)
    double value;  ///< front: in a; height: in 2 a
};
constexpr Reading kFront[] = {{0.41, 1.11}, {0.84, 1.22}, {1.19, 1.44}, {1.43, 1.67}, {1.63, 1.89},
                              {1.83, 2.11}, {1.98, 2.33}, {2.20, 2.56}, {2.32, 2.78}, {2.51, 3.00},
                              {2.65, 3.22}, {2.83, 3.44}, {2.98, 3.67}, {3.11, 3.89}, {3.33, 4.11}};
constexpr Reading kHeight[] = {{0.56, 0.94}, {0.77, 0.89}, {0.93, 0.83}, {1.08, 0.78},
                               {1.28, 0.72}, {1.46, 0.67}, {1.66, 0.61}, {1.84, 0.56}};

/// Advances to each reading's time and gives what `measure` says there, relative to what was read.
template <std::size_t N, typename Measure>
std::vector<double> errorsOf(Solver& solver, const Reading (&readings)[N], double unit, const Measure& measure) {
    std::vector<double> errors;
    double time = 0.0;
    for (const Reading& reading : readings) {
        const auto report = solver.advance(reading.time * unit - time, 1.0 / 120.0);
        EXPECT_TRUE(report.ok()) << report.error().message();
        time = reading.time * unit;
        errors.push_back(measure(solver.read().value().position) / reading.value - 1.0);
        std::printf("T %.2f: measured %.2f, off by %+.1f %%\n", reading.time, reading.value, 100.0 * errors.back());
    }
    return errors;
}

TEST_F(SimulationPhysics, ADamBreakFollowsMartinAndMoyce) {
    constexpr float kBase = 0.4F;  // a; 20 particles wide, 40 high, 6 deep
    constexpr float kSpacing = 0.02F;
    SimulationSettings settings;
    settings.radius = kSpacing / 2.0F;
    settings.low = {0, 0, 0};
    settings.high = {6.0F * kBase, 3.0F * kBase, 6.0F * kSpacing};
    const std::vector<float> start = lattice({0, 0, 0}, 20, 40, 6, kSpacing, 0.0F, 1);
    const auto base = double{kBase};
    const auto radius = double{settings.radius};
    const auto front = [&](const std::vector<float>& x) {
        double farthest = 0.0;
        for (std::size_t i = 0; i < x.size(); i += 3) {
            farthest = std::max(farthest, double{x[i]});
        }
        return (farthest + radius) / base;
    };
    const auto height = [&](const std::vector<float>& x) {  // of what stands at the wall
        double highest = 0.0;
        for (std::size_t i = 0; i < x.size(); i += 3) {
            highest = x[i] < 1.5F * kSpacing ? std::max(highest, double{x[i + 1]}) : highest;
        }
        return (highest + radius) / (2.0 * base);
    };
    // Water without friction leads the measured front, which had a gate to be drawn and a floor to rub on.
    for (const double error : errorsOf(*make(settings, start), kFront, std::sqrt(base / (2.0 * 9.81)), front)) {
        EXPECT_GT(error, -0.05);
        EXPECT_LT(error, 0.16);
    }
    for (const double error : errorsOf(*make(settings, start), kHeight, std::sqrt(base / 9.81), height)) {
        EXPECT_LT(std::abs(error), 0.06);
    }
}

TEST_F(SimulationPhysics, TheSameRunGivesTheSameBitsAndNothingEntersASolid) {
    SimulationSettings settings;
    settings.low = {0, 0, 0};
    settings.high = {1, 1, 0.4F};
    settings.solids = {sphereSolid({0.3F, 0.05F, 0.2F}, 0.12F),
                       boxSolid({0.7F, 0.1F, 0.2F}, {0.08F, 0.1F, 0.08F}, 30.0F)};
    const std::vector<float> positions = lattice({0.1F, 0.3F, 0}, 10, 10, 10, 0.04F, 0.002F, 5);
    const auto run = [&](bool twice) {
        const auto solver = make(settings, positions);
        if (twice) {  // what was there before, and how long its lists had to be, leaves no trace
            EXPECT_TRUE(solver->setParticles(std::vector<float>(300, 0.35F), {}).ok());
            EXPECT_TRUE(solver->step(0.001).ok());
            EXPECT_TRUE(solver->setParticles(positions, {}).ok());
        }
        for (int frame = 0; frame < 6; ++frame) {
            const auto report = solver->advance(1.0 / 30.0, 1.0 / 60.0);
            EXPECT_TRUE(report.ok()) << report.error().message();
        }
        return solver->read().value();
    };
    const ParticleState first = run(false);
    const ParticleState second = run(true);
    EXPECT_EQ(0, std::memcmp(first.position.data(), second.position.data(), 4 * first.position.size()));
    EXPECT_EQ(0, std::memcmp(first.velocity.data(), second.velocity.data(), 4 * first.velocity.size()));
    EXPECT_NE(first.position, positions);
    for (std::size_t i = 0; i < first.position.size(); i += 3) {
        for (const Solid& solid : settings.solids) {
            ASSERT_GT(distanceTo(solid, {first.position[i], first.position[i + 1], first.position[i + 2]}),
                      0.999 * double{settings.radius});
        }
    }
}

TEST_F(SimulationPhysics, AStepThatFliesTooFarIsSplitAndOneThatCannotBeIsReported) {
    SimulationSettings settings;
    settings.gravity = {0, 0, 0};
    const std::vector<float> positions = lattice({-0.5F, 0.5F, -0.5F}, 4, 4, 4, 0.04F, 0.0F, 1);
    std::vector<float> velocities(positions.size(), 0.0F);
    for (std::size_t i = 0; i < velocities.size(); i += 3) {
        velocities[i] = 8.0F;
    }
    const auto solver = make(settings, positions, velocities);
    const auto report = solver->advance(0.04, 0.04);
    ASSERT_TRUE(report.ok()) << report.error().message();
    // 0.32 m at 0.4 supports of 0.08 m per step: ten, or eleven as the particles also push each other a little.
    EXPECT_GE(report.value().steps, 10U);
    EXPECT_LE(report.value().steps, 11U);
    EXPECT_EQ(report.value().split, 0U);
    EXPECT_NEAR(report.value().shortest, 0.004, 5e-4);

    // A hundred particles in each other's place, which no step, however short, can take apart gently.
    const auto crowd = make(settings, std::vector<float>(300, 0.5F));
    const auto refused = crowd->advance(0.01, 0.01);
    if (refused.ok()) {
        EXPECT_GT(refused.value().steps, 1U);
    } else {
        EXPECT_THAT(refused.error().message(), HasSubstr("no step was stable"));
    }
}

TEST(StepRule, TakesTheFewestEqualPartsThatKeepToTheLimits) {
    const StepLimits limits{0.01, 0.004, 10.0};
    EXPECT_DOUBLE_EQ(nextStep(0.01, 0.0, limits), 0.01);
    EXPECT_DOUBLE_EQ(nextStep(0.03, 0.0, limits), 0.01);
    EXPECT_DOUBLE_EQ(nextStep(0.031, 0.0, limits), 0.031 / 4.0);
    for (const double speed : {0.0, 0.1, 1.0, 3.0, 50.0, 1e6}) {
        const double dt = nextStep(1.0 / 30.0, speed, limits);
        EXPECT_LE(speed * dt + 10.0 * dt * dt, 0.004 * (1.0 + 1e-9)) << speed;
        EXPECT_LE(dt, 0.01) << speed;
    }
    EXPECT_DOUBLE_EQ(nextStep(0.02, 0.0, {1.0, 0.004, 0.0}), 0.02);
}

TEST(CellTable, IsNeverMuchLargerThanItsParticles) {
    SimulationSettings settings;
    for (const float edge : {0.1F, 1.0F, 10.0F, 1000.0F}) {
        settings.low = {-edge, -edge, -edge};
        settings.high = {edge, edge, edge};
        for (const std::uint32_t particles : {1U, 1000U, 1'000'000U}) {
            const Grid grid = planGrid(settings, particles);
            EXPECT_LE(grid.cells(), std::max({1U << 16, 8 * particles, grid.x * 16})) << edge;
            EXPECT_LE(grid.cells(), kMostCells);
            EXPECT_EQ(grid.y & (grid.y - 1), 0U);
            EXPECT_GE(grid.y, 4U);
            EXPECT_GE(grid.side, double{settings.support()});
            EXPECT_GE(static_cast<double>(grid.x - 2) * grid.side, 2.0 * double{edge});
        }
    }
}

TEST(SolidsWithin, LeavesOutWhatOnlyTouchesTheDomain) {
    SimulationSettings settings;  // x and z in [-1, 1], y in [0, 2]
    settings.solids = {planeSolid({0, 1, 0}, {0, 0, 0}), boxSolid({1.2F, 1, 0}, {0.2F, 1, 1}),
                       sphereSolid({0, 2.5F, 0}, 0.5F), capsuleSolid({-1.5F, 0, 0}, {-1.5F, 2, 0}, 0.5F)};
    EXPECT_TRUE(solidsWithin(settings).empty());
    const std::vector<Solid> reaching{planeSolid({0, 1, 0}, {0, 0.01F, 0}), planeSolid({0.1F, 1, 0}, {0, 0, 0}),
                                      boxSolid({1.2F, 1, 0}, {0.2F, 1, 1}, 10.0F), sphereSolid({0, 2.5F, 0}, 0.51F),
                                      capsuleSolid({-1.5F, 0, 0}, {-1.49F, 2, 0}, 0.5F)};
    settings.solids.insert(settings.solids.end(), reaching.begin(), reaching.end());
    EXPECT_EQ(solidsWithin(settings).size(), reaching.size());
}

TEST(SimulationSettingsCheck, NamesWhatIsWrong) {
    const auto message = [](const auto& change) {
        SimulationSettings settings;
        change(settings);
        const Status status = checkSettings(settings);
        return status.ok() ? std::string() : status.error().message();
    };
    EXPECT_EQ(message([](SimulationSettings&) {}), "");
    EXPECT_EQ(message([](SimulationSettings& s) { s.radius = 0.0F; }),
              "simulation: radius: expected a number in [1e-05, 1000], found 0");
    EXPECT_THAT(message([](SimulationSettings& s) { s.high[1] = s.low[1]; }), HasSubstr("4 radii"));
    EXPECT_THAT(message([](SimulationSettings& s) { s.high[1] = 1e9F; }), HasSubstr("100,000 radii"));
    EXPECT_THAT(message([](SimulationSettings& s) { s.gravity[0] = NAN; }), HasSubstr("gravity: expected finite"));
    EXPECT_THAT(message([](SimulationSettings& s) { s.iterations = 0; }), HasSubstr("iterations: expected 1 to 64"));
    EXPECT_THAT(message([](SimulationSettings& s) {
                    s.kernel = DensityKernel::Wendland;
                    s.iterations = 1;
                }),
                HasSubstr("iterations: expected 2 to 64 with a kernel other than poly6, found 1"));
    EXPECT_THAT(message([](SimulationSettings& s) { s.solids = {sphereSolid({}, -1)}; }),
                HasSubstr("solid 0: expected a radius > 0, found -1"));
    EXPECT_THAT(message([](SimulationSettings& s) { s.solids.resize(65, sphereSolid({}, 1)); }),
                HasSubstr("at most 64 that reach into the domain, found 65"));
}

}  // namespace
}  // namespace sluice::vk::test
