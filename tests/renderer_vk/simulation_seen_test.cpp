// SPDX-License-Identifier: MIT
// What a camera sees as a solid: a step against the reference, the hard places one by one, and water on it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "reference/simulation_reference.hpp"
#include "seen_rig.hpp"
#include "simulation_rig.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

class SimulationSeen : public SimulationTest {
  protected:
    static SimulationSettings with(DepthField field) {
        SimulationSettings settings;
        settings.radius = kRadius;
        settings.low = {0, 0, 0};
        settings.high = {1, 1, 1};
        settings.seen = std::make_shared<const DepthField>(std::move(field));
        return settings;
    }
    /// Where a particle that is all alone is after a step.
    [[nodiscard]] Vector after(const DepthField& field, const Vector& x, const Vector& velocity = {}) const {
        SimulationSettings settings = with(field);
        settings.gravity = {0, 0, 0};
        const auto at = narrow(x);
        const auto fast = narrow(velocity);
        const auto solver = make(settings, {at.begin(), at.end()}, {fast.begin(), fast.end()});
        EXPECT_TRUE(solver->step(0.01).ok());
        return vectorsOf(solver->read().value().position).front();
    }
};

/// Of what is as thin as it may be, and of what nobody gets behind.
class SimulationSeenOf : public SimulationSeen, public ::testing::WithParamInterface<float> {};
INSTANTIATE_TEST_SUITE_P(Thickness, SimulationSeenOf, ::testing::Values(kRadius, 10.0F));

TEST_P(SimulationSeenOf, AStepMatchesTheDoublePrecisionReference) {
    // A floor that leans, a pillar and a crate on it, seen from above at an angle; a corner of the image is empty.
    const DepthView camera = looking({0.1, 0.9, 1.3}, {0.5, 0.15, 0.4}, 48, 36);
    DepthField field = picture(
        camera, 48, 36,
        {planeSolid({0.1F, 1, 0.05F}, {0.5F, 0.1F, 0.5F}), capsuleSolid({0.35F, 0, 0.4F}, {0.35F, 0.4F, 0.4F}, 0.07F),
         boxSolid({0.62F, 0.18F, 0.5F}, {0.09F, 0.09F, 0.09F}, 25.0F)});
    field.thickness = GetParam();
    Dice holes(9);
    for (float& depth : field.depth) {
        const float chance = holes.between(0.0F, 1.0F);
        depth = chance < 0.01F ? std::numeric_limits<float>::quiet_NaN() : chance < 0.02F ? -1.0F : depth;
    }
    SimulationSettings settings = with(field);
    settings.vorticity = 0.5F;
    settings.solids = {sphereSolid({0.85F, 0.3F, 0.8F}, 0.06F)};
    std::vector<float> positions;
    for (const std::vector<float>& block : {lattice({0.25F, 0.08F, 0.25F}, 9, 7, 9, 0.037F, 0.008F, 7),
                                            lattice({0.52F, 0.02F, 0.4F}, 6, 10, 6, 0.037F, 0.008F, 8)}) {
        for (std::size_t i = 0; i < block.size(); i += 3) {
            const Vector x{double{block[i]}, double{block[i + 1]}, double{block[i + 2]}};
            if (distanceTo(settings.solids[0], narrow(x)) > 0.0) {
                positions.insert(positions.end(), block.begin() + static_cast<std::ptrdiff_t>(i),
                                 block.begin() + static_cast<std::ptrdiff_t>(i + 3));
            }
        }
    }
    Dice dice(3);
    std::vector<float> velocities(positions.size());
    std::generate(velocities.begin(), velocities.end(), [&] { return dice.between(-1.0F, 1.0F); });
    constexpr double kDt = 1.0 / 256.0;
    const auto solver = make(settings, positions, velocities);
    ASSERT_TRUE(solver->step(kDt).ok());
    const std::vector<Vec> x = vectorsOf(solver->read().value().position);
    const auto density = solver->densities();
    ASSERT_TRUE(density.ok());
    const auto farthestFrom = [&](const SimulationSettings& s) {
        const ReferenceState expected = referenceStep(s, {vectorsOf(positions), vectorsOf(velocities), {}}, kDt);
        double farthest = 0.0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            farthest = std::max(farthest, apart(x[i], expected.position[i]));
        }
        return std::pair(farthest, expected.density);
    };
    const auto [off, expected_density] = farthestFrom(settings);
    double densest = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        densest = std::max(densest, std::abs(double{density.value()[i]} - expected_density[i]));
    }
    RecordProperty("radii", std::to_string(off / double{kRadius}));
    RecordProperty("density", std::to_string(densest));
    EXPECT_LT(off, 2e-4 * double{kRadius});
    EXPECT_LT(densest, 2e-4);
    SimulationSettings blind = settings;
    blind.seen = nullptr;
    EXPECT_GT(farthestFrom(blind).first, 0.5 * double{kRadius}) << "the field does nothing";
    if (GetParam() > kRadius) {
        field.thickness = kRadius;
        SimulationSettings thin = settings;
        thin.seen = std::make_shared<const DepthField>(field);
        EXPECT_GT(farthestFrom(thin).first, 0.1 * double{kRadius}) << "nobody came round an edge";
    }
}

TEST_F(SimulationSeen, HardPlacesAreLeftAloneOrLeftBySmallSteps) {
    // A wall at z = 0.3 that faces the eye at z = 0.9.
    constexpr std::uint32_t kSide = 8;
    DepthView camera = looking({0.5, 0.5, 0.9}, {0.5, 0.5, 0}, kSide, kSide);
    camera.projection[8] = camera.projection[9] = 0.0F;
    DepthField wall{kSide, kSide, {kSide, kSide}, camera, 0.16F, std::vector<float>(std::size_t{kSide} * kSide, 0.6F)};
    const Vector in_front{0.52, 0.53, 0.5};
    EXPECT_LT(apart(after(wall, in_front), in_front), 1e-6);
    // In front: left alone, however near. In it: to its face, by a quarter of a radius a step.
    const Vector near_it{0.52, 0.53, 0.31};
    EXPECT_LT(apart(after(wall, near_it), near_it), 1e-6);
    EXPECT_NEAR(after(wall, {0.52, 0.53, 0.25})[2], 0.255, 1e-6);
    EXPECT_NEAR(after(wall, {0.52, 0.53, 0.298})[2], 0.3, 1e-6);
    // Behind: free, in what the eye does not see, and stopped where it would come into it.
    const Vector hidden{0.52, 0.53, 0.13};
    EXPECT_LT(apart(after(wall, hidden), hidden), 1e-6);
    EXPECT_NEAR(after(wall, hidden, {0, 0, 2.0})[2], 0.14, 1e-6) << "and stopped by its back";
    EXPECT_NEAR(after(wall, hidden, {0, 0, -2.0})[2], 0.11, 1e-6);
    EXPECT_NEAR(after(wall, {0.52, 0.53, 0.34}, {0, 0, -3})[2], 0.32, 1e-6) << "as by its front";
    // Behind the camera, nearer than its near plane, beside its view.
    for (const Vector& x : {Vector{0.5, 0.5, 0.97}, Vector{0.5, 0.5, 0.88}, Vector{0.05, 0.5, 0.6}}) {
        EXPECT_LT(apart(after(wall, x), x), 1e-6);
    }
    DepthField close = wall;
    close.depth.assign(close.depth.size(), 0.0625F);
    EXPECT_NEAR(after(close, {0.5, 0.5, 0.83})[2], 0.835, 1e-4) << "nearer than twice the near plane";
    // No depth at all, of any kind.
    for (const float nothing : {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN(), 0.0F, -0.6F, 1e30F,
                                std::numeric_limits<float>::denorm_min()}) {
        DepthField empty = wall;
        empty.depth.assign(empty.depth.size(), nothing);
        const Vector x{0.52, 0.53, 0.29};
        EXPECT_LT(apart(after(empty, x), x), 1e-6) << nothing;
    }
    EXPECT_LT(apart(after(DepthField{}, hidden), hidden), 1e-6);
    // One texel is a plane that faces the eye.
    const DepthField one{1, 1, {1, 1}, camera, 0.16F, {0.6F}};
    EXPECT_NEAR(after(one, {0.5, 0.5, 0.29})[2], 0.295, 1e-6);
    // So is a texel whose neighbours are all far away, though they are not empty.
    DepthField pole = wall;
    pole.depth.assign(pole.depth.size(), 40.0F);
    pole.depth[4 * kSide + 4] = 0.6F;
    const Vector at{0.53, 0.53, 0.27};
    const Vector pushed = after(pole, at);
    EXPECT_GT(dot(unit(minus(pushed, at)), unit(minus(Vector{0.5, 0.5, 0.9}, at))), 0.99);
}

TEST_F(SimulationSeen, NobodyIsPushedOverASilhouette) {
    // A crate seen from the front: beside it, in front of its silhouette and behind it particles fall straight down.
    const DepthView camera = looking({0.5, 0.5, 1.9}, {0.5, 0.5, 0}, 64, 64);
    const DepthField field = picture(camera, 64, 64, {boxSolid({0.5F, 0.5F, 0.7F}, {0.1F, 0.1F, 0.1F})});
    SimulationSettings settings = with(field);
    settings.low = {0, 0, 0};
    std::vector<float> positions;
    for (const Triple& x : {Triple{0.378F, 0.9F, 0.7F},
                            {0.622F, 0.9F, 0.75F},
                            {0.5F, 0.9F, 0.35F},
                            {0.42F, 0.9F, 0.4F},
                            {0.5F, 0.9F, 0.9F},
                            {0.39F, 0.9F, 0.95F}}) {
        positions.insert(positions.end(), x.begin(), x.end());
    }
    const auto solver = make(settings, positions);
    ASSERT_TRUE(solver->advance(0.3, 1.0 / 240.0).ok());
    const std::vector<float> moved = solver->read().value().position;
    for (std::size_t i = 0; i < moved.size(); i += 3) {
        EXPECT_NEAR(moved[i], positions[i], 1e-5F) << i / 3;
        EXPECT_NEAR(moved[i + 1], 0.9F - 0.5F * 9.81F * 0.09F, 0.01F) << i / 3;
        EXPECT_NEAR(moved[i + 2], positions[i + 2], 1e-5F) << i / 3;
    }
}

TEST_F(SimulationSeen, ASurfaceThatComesOverTheFluidGivesItNoSpeedAndTheWatchSeesIt) {
    DepthView camera = looking({0.5, 0.98, 0.5}, {0.5, 0, 0.5}, 32, 32, {0, 0, -1});
    DepthField field{32, 32, {32, 32}, camera, 0.24F, std::vector<float>(1024, 0.88F)};  // a floor at 0.1
    SimulationSettings settings = with(field);
    settings.gravity = {0, 0, 0};
    const auto solver = make(settings, lattice({0.3F, 0.1F, 0.3F}, 8, 3, 8, 0.041F, 0.0F, 1));
    ASSERT_TRUE(solver->step(0.005).ok());
    std::fill(field.depth.begin(), field.depth.end(), 0.84F);  // and now at 0.14, by less than a texel is wide
    ASSERT_TRUE(solver->setDepthField(field).ok());
    double fastest = 0.0;
    for (int step = 0; step < 24; ++step) {
        const auto report = solver->step(0.005);
        ASSERT_TRUE(report.ok());
        fastest = std::max(fastest, report.value().speed);
        if (step < 4) {
            EXPECT_GT(report.value().move, 0.249 * double{kRadius}) << step;
        }
        EXPECT_LT(report.value().move, 1.5 * double{kRadius}) << step;
    }
    const ParticleState state = solver->read().value();
    double lowest = 1.0;
    for (std::size_t i = 1; i < state.position.size(); i += 3) {
        lowest = std::min(lowest, double{state.position[i]});
    }
    RecordProperty("fastest", std::to_string(fastest));
    EXPECT_LT(fastest, 2.0) << "m/s; the surface comes at one";
    EXPECT_GT(lowest, 0.14 - 0.01 * double{kRadius});
    // A surface that jumps over more than that leaves who was in front behind it.
    std::fill(field.depth.begin(), field.depth.end(), 0.5F);
    ASSERT_TRUE(solver->setDepthField(field).ok());
    ASSERT_TRUE(solver->advance(0.1, 0.005).ok());
}

TEST_F(SimulationSeen, WaterOnAFloorThatIsSeenIsWaterOnAFloor) {
    const DepthView camera = looking({0.5, 1.6, 0.7}, {0.5, 0.1, 0.25}, 160, 120);
    const Solid floor = planeSolid({0, 1, 0}, {0, 0.1F, 0});
    const auto run = [&](bool seen) {
        SimulationSettings settings = with(picture(camera, 160, 120, {floor}));
        settings.high = {1, 1, 0.6F};
        if (!seen) {
            settings.seen = nullptr;
            settings.solids = {floor};
        }
        const auto solver = make(settings, lattice({0.1F, 0.12F, 0.0F}, 8, 9, 15, 0.04F, 0.001F, 4));
        for (int frame = 0; frame < 12; ++frame) {
            EXPECT_TRUE(solver->advance(1.0 / 30.0, 1.0 / 120.0).ok());
        }
        return vectorsOf(solver->read().value().position);
    };
    const std::vector<Vector> on_seen = run(true);
    const std::vector<Vector> on_solid = run(false);
    const auto mean = [](const std::vector<Vector>& x, std::size_t axis) {
        double sum = 0.0;
        for (const Vector& at : x) {
            sum += at.at(axis);
        }
        return sum / static_cast<double>(x.size());
    };
    const double lowest = (*std::min_element(on_seen.begin(), on_seen.end(),
                                             [](const Vector& a, const Vector& b) { return a[1] < b[1]; }))[1];
    RecordProperty("lowest", std::to_string(lowest));
    RecordProperty("mean_x", std::to_string(mean(on_seen, 0)) + " " + std::to_string(mean(on_solid, 0)));
    RecordProperty("mean_y", std::to_string(mean(on_seen, 1)) + " " + std::to_string(mean(on_solid, 1)));
    EXPECT_GT(lowest, 0.1 + 0.9 * double{kRadius}) << "a radius along the view";
    EXPECT_NEAR(mean(on_seen, 0), mean(on_solid, 0), 0.015);
    EXPECT_NEAR(mean(on_seen, 1), mean(on_solid, 1), 0.012);
}

TEST_F(SimulationSeen, WaterRunsAroundACrateAndHardlyIntoItAndBehindItItIsFree) {
    const DepthView camera = looking({0.5, 0.8, 1.1}, {0.5, 0.1, 0.25}, 160, 120);
    const Solid crate = boxSolid({0.6F, 0.1F, 0.3F}, {0.1F, 0.1F, 0.1F}, 20.0F);
    SimulationSettings settings = with(picture(camera, 160, 120, {planeSolid({0, 1, 0}, {0, 0, 0}), crate}));
    settings.high = {1, 1, 0.6F};
    const auto solver = make(settings, lattice({0.0F, 0.0F, 0.0F}, 10, 9, 15, 0.04F, 0.001F, 4));
    std::size_t inside = 0;
    for (int frame = 0; frame < 12; ++frame) {
        ASSERT_TRUE(solver->advance(1.0 / 30.0, 1.0 / 120.0).ok());
        for (const Vector& x : vectorsOf(solver->read().value().position)) {
            inside += contactWith(crate, x).distance < 0.0 ? 1U : 0U;
        }
    }
    RecordProperty("inside", std::to_string(inside) + " of 12 times " + std::to_string(solver->count()));
    EXPECT_LT(inside, 12U * solver->count() / 100U);
}

TEST_F(SimulationSeen, AReducedImageKeepsWhatIsNearestAndAViewThatIsNoWholeNumberOfTexels) {
    const DepthView camera = looking({0.5, 0.5, 0.9}, {0.5, 0.5, 0}, 5, 3);
    std::vector<float> depths(15, 2.0F);
    depths[4] = 0.5F;
    depths[7] = std::numeric_limits<float>::quiet_NaN();
    depths[11] = -3.0F;
    const DepthField field = depthField(camera, 5, 3, 2, 0.16F, depths);
    EXPECT_EQ(field.width, 3U);
    EXPECT_EQ(field.height, 2U);
    EXPECT_EQ(field.depth, (std::vector<float>{2, 2, 0.5F, 2, 2, 2}));
    EXPECT_EQ(field.view_size, (std::array<float, 2>{2.5F, 1.5F}));
    EXPECT_TRUE(checkDepthField(field, kRadius).ok());
    EXPECT_EQ(depthField(camera, 1, 1, 4, 0.16F, {kInfinity}).depth, std::vector<float>{1e30F});
}

TEST_F(SimulationSeen, WhatIsNoCameraOrNoImageIsRefused) {
    const DepthView camera = looking({0.5, 0.5, 0.9}, {0.5, 0.5, 0}, 4, 4);
    const DepthField good{4, 4, {4, 4}, camera, 0.16F, std::vector<float>(16, 0.6F)};
    EXPECT_TRUE(checkSettings(with(good)).ok());
    const auto refused = [](const DepthField& field) {
        const Status status = checkSettings(with(field));
        return status.ok() ? std::string() : status.error().message();
    };
    DepthField bad = good;
    bad.depth.pop_back();
    EXPECT_THAT(refused(bad), HasSubstr("depth field: expected at most"));
    bad = good;
    bad.view_size[0] = 2.5F;
    EXPECT_THAT(refused(bad), HasSubstr("depth field: expected at most"));
    bad = good;
    bad.thickness = 0.015F;
    EXPECT_THAT(refused(bad), HasSubstr("a thickness of 0.02 m (a radius) or more, found 0.015"));
    bad = good;
    bad.camera.near_plane = 0.0F;
    EXPECT_THAT(refused(bad), HasSubstr("a near plane of 0"));
    bad = good;
    bad.camera.view[0] *= 2.0F;
    EXPECT_THAT(refused(bad), HasSubstr("a view that only turns and moves"));
    bad = good;
    bad.camera.projection[11] = 0.0F;
    bad.camera.projection[15] = 1.0F;
    EXPECT_THAT(refused(bad), HasSubstr("an OpenGL perspective"));
    bad = good;
    bad.camera.view[13] = kInfinity;
    EXPECT_THAT(refused(bad), HasSubstr("finite matrices"));
    SimulationSettings bodies = with(good);
    bodies.bodies.emplace_back();
    bodies.bodies[0].half = {0.1F, 0.1F, 0.1F};
    bodies.bodies[0].centre = {0.5F, 0.5F, 0.5F};
    EXPECT_THAT(checkSettings(bodies).error().message(), HasSubstr("none beside a depth field"));
    SimulationSettings blind = with(good);
    blind.seen = nullptr;
    EXPECT_THAT(make(blind, {0.5F, 0.5F, 0.5F})->setDepthField(good).error().message(), HasSubstr("made without one"));
}

}  // namespace
}  // namespace sluice::vk::test
