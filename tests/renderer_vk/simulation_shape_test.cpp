// SPDX-License-Identifier: MIT
// Ellipsoids of particles against double precision: after a step, and for what has no shape to speak of.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "reference/shape_reference.hpp"
#include "simulation_rig.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

/// What the buffer holds before the pass: no ellipsoid has it.
constexpr float kUntouched = -77.0F;

class SimulationShape : public SimulationTest {
  protected:
    [[nodiscard]] std::vector<float> ellipsoids(Solver& solver, const Anisotropy& how, std::size_t count) const {
        return filled(kEllipsoidFloats * count, kUntouched, [&](VkBuffer to) { return solver.ellipsoids(how, to); });
    }
};

/// Greatest difference of a stretch, and of a centre in metres.
struct Off {
    double stretch = 0.0, centre = 0.0;
};

Off offOf(const float* found, const ReferenceEllipsoid& expected) {
    Off off;
    constexpr std::array<std::array<std::size_t, 2>, 6> kEntries{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};
    for (std::size_t k = 0; k < 3; ++k) {
        off.centre = std::max(off.centre, std::abs(double{found[k]} - expected.centre.at(k)));
    }
    for (std::size_t k = 0; k < kEntries.size(); ++k) {
        off.stretch = std::max(off.stretch,
                               std::abs(double{found[3 + k]} - expected.stretch.at(kEntries[k][0]).at(kEntries[k][1])));
    }
    return off;
}

Off greatest(const std::vector<float>& found, const std::vector<Vector>& x,
             const std::vector<std::vector<std::uint32_t>>& lists, double h, const Anisotropy& how) {
    Off most;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Off off = offOf(&found[kEllipsoidFloats * i], referenceEllipsoid(x, i, lists[i], h, how));
        // Negated so that NaN is the greatest.
        most.stretch = !(off.stretch <= most.stretch) ? off.stretch : most.stretch;
        most.centre = !(off.centre <= most.centre) ? off.centre : most.centre;
    }
    return most;
}

/// docs/simulation.md states these.
constexpr double kStretchBound = 2e-5;
constexpr double kCentreBound = 1e-5;  // of a radius

TEST_F(SimulationShape, AfterAStepItIsTheDoublePrecisionReference) {
    SimulationSettings settings;
    settings.radius = 0.02F;
    settings.low = {0, 0, 0};
    settings.high = {1, 1, 1};
    settings.solids = {sphereSolid({0.2F, 0.0F, 0.2F}, 0.06F)};
    std::vector<float> positions = lattice({0.3F, 0.02F, 0.3F}, 9, 6, 7, 0.04F, 0.012F, 7);
    for (const std::vector<float>& more : {lattice({0.1F, 0.7F, 0.1F}, 12, 1, 9, 0.038F, 0.003F, 8),    // a sheet
                                           lattice({0.1F, 0.5F, 0.8F}, 15, 1, 1, 0.04F, 0.004F, 9)}) {  // a thread
        positions.insert(positions.end(), more.begin(), more.end());
    }
    const auto solver = make(settings, positions);
    ASSERT_TRUE(solver->step(1.0 / 256.0).ok());
    for (const Anisotropy& how : {Anisotropy{}, Anisotropy{10.0F, 0.9F, 0.3F}, Anisotropy{1.0F, 0.0F, 1.0F}}) {
        const std::vector<float> found = ellipsoids(*solver, how, positions.size() / 3);
        const Off off = greatest(found, vectorsOf(solver->read().value().position), solver->lists().value().list,
                                 double{settings.support()}, how);
        RecordProperty(fmt::format("stretch_{}", how.ratio), fmt::format("{:.2e}", off.stretch));
        RecordProperty(fmt::format("centre_{}", how.ratio),
                       fmt::format("{:.2e}", off.centre / double{settings.radius}));
        EXPECT_LT(off.stretch, kStretchBound) << how.ratio;
        EXPECT_LT(off.centre, kCentreBound * double{settings.radius}) << how.ratio;
        EXPECT_EQ(found, ellipsoids(*solver, how, positions.size() / 3)) << "the same bits";
    }
    // What the cases are there for: the sheet is flat, the thread long, the middle of the block neither.
    const auto diagonal = [found = ellipsoids(*solver, {}, positions.size() / 3)](std::size_t i) {
        return Vector{double{found[kEllipsoidFloats * i + 3]}, double{found[kEllipsoidFloats * i + 6]},
                      double{found[kEllipsoidFloats * i + 8]}};
    };
    EXPECT_LT(diagonal(378 + 12 * 4 + 6)[1], 0.6);
    EXPECT_GT(diagonal(378 + 108 + 7)[0], 1.5);
    EXPECT_NEAR(diagonal(9 * 6 * 3 + 9 * 3 + 4)[1], 1.0, 0.2);
}

/// Every other particle nearer than the support, by trying all.
std::vector<std::vector<std::uint32_t>> allPairs(const std::vector<Vector>& x, double h) {
    std::vector<std::vector<std::uint32_t>> lists(x.size());
    for (std::uint32_t i = 0; i < x.size(); ++i) {
        for (std::uint32_t j = 0; j < x.size(); ++j) {
            if (i != j && apart(x[i], x[j]) < h) {
                lists[i].push_back(j);
            }
        }
    }
    return lists;
}

TEST_F(SimulationShape, BeforeAnyStepCoincidentCollinearCoplanarAndLonelyOnesMatchToo) {
    SimulationSettings settings;
    settings.radius = 0.02F;
    settings.low = {-4, 0, -4};
    settings.high = {4, 8, 4};
    std::vector<float> positions;
    const auto add = [&](float x, float y, float z) { positions.insert(positions.end(), {x, y, z}); };
    add(-3, 1, 0);  // nobody near
    add(-2, 1, 0);  // a pair
    add(-1.99F, 1, 0);
    for (int i = 0; i < 100; ++i) {  // all in one place, more than the lists had room for
        add(-1, 1, 0);
    }
    for (int i = 0; i < 9; ++i) {  // a line along a diagonal, a line along an axis, a plane askew
        const float s = 0.03F * static_cast<float>(i);
        add(s, 1 + s, s);
        add(1 + s, 1, 0);
        for (int j = 0; j < 9; ++j) {
            const float t = 0.03F * static_cast<float>(j);
            add(2 + s, 1 + 0.5F * s + 0.25F * t, t);
        }
    }
    add(3, 1, 0);  // four in a square: two axes alike
    add(3.04F, 1, 0);
    add(3, 1.04F, 0);
    add(3.04F, 1.04F, 0);
    const auto solver = make(settings, positions);
    const std::vector<Vector> x = vectorsOf(positions);
    const auto h = double{settings.support()};
    const Anisotropy how{8.0F, 0.5F, 0.5F};
    const std::vector<float> found = ellipsoids(*solver, how, x.size());
    const Off off = greatest(found, x, allPairs(x, h), h, how);
    EXPECT_LT(off.stretch, kStretchBound);
    EXPECT_LT(off.centre, kCentreBound * double{settings.radius});
    for (std::size_t i = 0; i < 9; ++i) {  // nobody near: a small sphere where the particle is
        EXPECT_EQ(found[i], i < 3 ? positions[i] : i == 3 || i == 6 || i == 8 ? 0.5F : 0.0F) << i;
    }
    EXPECT_EQ(solver->read().value().position, positions) << "the search has moved nothing";
    ASSERT_TRUE(solver->step(0.001).ok());
    EXPECT_NE(ellipsoids(*solver, how, x.size()), found) << "a step makes new ones";
}

TEST_F(SimulationShape, VolumeIsKeptNoAxisIsLongerThanSaidAndWrongSettingsAreNamed) {
    SimulationSettings settings;
    const std::vector<float> positions = lattice({-0.5F, 0.1F, -0.5F}, 8, 5, 6, 0.04F, 0.015F, 3);
    const auto solver = make(settings, positions);
    const std::vector<float> found = ellipsoids(*solver, {}, positions.size() / 3);
    for (std::size_t i = 0; i < found.size(); i += kEllipsoidFloats) {
        const auto xx = double{found[i + 3]};
        const auto xy = double{found[i + 4]};
        const auto xz = double{found[i + 5]};
        const auto yy = double{found[i + 6]};
        const auto yz = double{found[i + 7]};
        const auto zz = double{found[i + 8]};
        const double volume = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
        ASSERT_NEAR(volume, 1.0, 1e-4) << "all of these have neighbours enough";
        ASSERT_LT(std::max({xx, yy, zz}), double{longestStretch(Anisotropy{}.ratio)} + 1e-4);
    }
    for (const Anisotropy& wrong : {Anisotropy{0.5F, 0, 1}, Anisotropy{NAN, 0, 1}, Anisotropy{11, 0, 1},
                                    Anisotropy{4, 1.5F, 1}, Anisotropy{4, 0, 0}}) {
        const Status status = solver->ellipsoids(wrong, VK_NULL_HANDLE);
        ASSERT_FALSE(status.ok());
        EXPECT_THAT(status.error().message(), HasSubstr("anisotropy"));
    }
}

TEST_F(SimulationShape, WhoWasBornInTheStepIsRoundAndWhoIsGoneHasNone) {
    SimulationSettings settings;
    settings.radius = 0.02F;
    settings.gravity = {0, 0, 0};
    Drain drain;
    drain.centre = {0.5F, 0.5F, 0.5F};
    drain.half = {0.05F, 0.05F, 0.05F};
    settings.sources.drains = {drain};
    Emitter emitter;
    emitter.centre = {-0.5F, 1.0F, -0.5F};
    emitter.width = 0.1F;
    emitter.speed = 2.0F;
    settings.sources.emitters = {emitter};
    const std::vector<float> positions{0.5F, 0.5F, 0.5F, 0.1F, 0.9F, 0.1F};
    const auto solver = make(settings, positions);
    const auto report = solver->step(1.0 / 100.0);
    ASSERT_TRUE(report.ok()) << report.error().message();
    ASSERT_GT(report.value().born, 1U);
    ASSERT_EQ(report.value().drained, 1U);
    const std::vector<float> found = ellipsoids(*solver, {}, 2 + report.value().born);
    EXPECT_TRUE(std::all_of(found.begin(), found.begin() + 9, [](float v) { return v == kUntouched; }));
    for (std::size_t i = 1; i < 2 + report.value().born; ++i) {
        EXPECT_EQ(found[9 * i + 3], 0.5F);
        EXPECT_EQ(found[9 * i + 4], 0.0F);
    }
}

}  // namespace
}  // namespace sluice::vk::test
