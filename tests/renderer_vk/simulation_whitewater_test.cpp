// SPDX-License-Identifier: MIT
// Potentials of spray, foam and bubbles against double precision, from the formulas of Ihmsen et al. 2012.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "live/foam_age.hpp"
#include "reference/simulation_terms.hpp"
#include "simulation_rig.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

class SimulationWhitewater : public SimulationTest {
  protected:
    [[nodiscard]] std::vector<float> potentials(Solver& solver, const Whitewater& how, std::size_t count) const {
        return filled(kWhitewaterFloats * count, -1.0F, [&](VkBuffer to) { return solver.whitewater(how, to); });
    }
};

struct Expected {
    std::array<double, 3> potential{};
    bool close = false;  ///< to one of the two thresholds where it leaps: either side is right
};

double part(double value, const WhitewaterRange& range) {
    return std::clamp((value - double{range.low}) / (double{range.high} - double{range.low}), 0.0, 1.0);
}

/// Outward unit normals of the colour field, fluid at rest standing for walls; and how much each is at the surface.
struct Normals {
    std::vector<Vec> unit;
    std::vector<double> share;
};

Normals normalsOf(const SimulationSettings& settings, const std::vector<Vec>& x,
                  const std::vector<std::vector<std::uint32_t>>& lists) {
    const reference::Kernels kernels(double{settings.radius});
    Normals made;
    for (std::size_t i = 0; i < x.size(); ++i) {
        Vec sum = reference::wallsAt(settings, {}, kernels, x[i]).gradient;
        for (const std::uint32_t j : lists[i]) {
            sum = plus(sum, times(kernels.volume, kernels.gradient(minus(x[i], x[j]))));
        }
        const double length = kernels.h * reference::norm(sum);
        const double t = std::clamp((length - 0.2) / 0.4, 0.0, 1.0);
        made.unit.push_back(times(-kernels.h / std::max(length, 1e-6), sum));
        made.share.push_back(t * t * (3.0 - 2.0 * t));
    }
    return made;
}

Expected expectedOf(std::size_t i, const std::vector<Vec>& x, const std::vector<Vec>& v, const Normals& normals,
                    const std::vector<std::uint32_t>& list, double h, const Whitewater& how) {
    Expected out;
    double air = 0.0;
    double crest = 0.0;
    for (const std::uint32_t j : list) {
        const Vec d = minus(x[i], x[j]);
        const double distance = reference::norm(d);
        const double weight = std::max(1.0 - distance / h, 0.0);
        const Vec apart = minus(v[i], v[j]);
        air += weight * (reference::norm(apart) - dot(apart, d) / distance);
        const double above = dot(d, normals.unit[i]) / distance;
        out.close = out.close || std::abs(above) < 1e-4;
        if (above > 0.0) {
            crest += weight * normals.share[j] * (1.0 - dot(normals.unit[i], normals.unit[j]));
        }
    }
    const double speed = reference::norm(v[i]);
    const double ahead = dot(v[i], normals.unit[i]) / speed;
    out.close = out.close || std::abs(ahead - 0.6) < 1e-4;
    out.potential = {part(air, how.air), ahead >= 0.6 ? part(crest * normals.share[i], how.crest) : 0.0,
                     part(0.5 * speed * speed, how.energy)};
    return out;
}

TEST_F(SimulationWhitewater, OfACrestThatFallsIntoWaterIsTheDoublePrecisionReference) {
    SimulationSettings settings;
    settings.radius = 0.02F;
    settings.low = {0, 0, 0};
    settings.high = {0.8F, 1, 0.6F};
    settings.solids = {sphereSolid({0.6F, 0.0F, 0.3F}, 0.1F)};
    std::vector<float> positions = lattice({0, 0, 0}, 12, 4, 8, 0.04F, 0.008F, 4);
    std::vector<float> velocities(positions.size(), 0.0F);
    const std::vector<float> wedge = lattice({0.1F, 0.165F, 0.04F}, 5, 6, 5, 0.04F, 0.008F, 5);
    positions.insert(positions.end(), wedge.begin(), wedge.end());
    Dice dice(6);
    for (std::size_t i = 0; i < wedge.size(); i += 3) {
        velocities.insert(velocities.end(), {2.0F + dice.between(0, 1), dice.between(-2, 1), dice.between(-1, 1)});
    }
    const auto solver = make(settings, positions, velocities);
    const Whitewater how{{0.5F, 15.0F}, {0.1F, 3.0F}, {0.1F, 6.0F}};
    const std::size_t count = positions.size() / 3;
    const std::vector<float> still = potentials(*solver, how, count);
    EXPECT_TRUE(std::all_of(still.begin(), still.end(), [](float p) { return p == 0.0F; })) << "before any step";
    ASSERT_TRUE(solver->step(1.0 / 256.0).ok());
    const std::vector<float> found = potentials(*solver, how, count);
    const ParticleState state = solver->read().value();
    const std::vector<Vec> x = vectorsOf(state.position);
    const std::vector<Vec> v = vectorsOf(state.velocity);
    const auto lists = solver->lists().value().list;
    const Normals normals = normalsOf(settings, x, lists);
    std::array<double, 3> off{};
    std::array<std::size_t, 3> between{};
    std::size_t skipped = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Expected expected = expectedOf(i, x, v, normals, lists[i], double{settings.support()}, how);
        for (std::size_t k = 0; k < 3; ++k) {
            if (k == 1 && expected.close) {
                ++skipped;
                continue;
            }
            off.at(k) =
                std::max(off.at(k), std::abs(double{found[kWhitewaterFloats * i + k]} - expected.potential.at(k)));
            between.at(k) += expected.potential.at(k) > 0.0 && expected.potential.at(k) < 1.0 ? 1U : 0U;
        }
    }
    for (std::size_t i = 0; i < found.size(); i += kWhitewaterFloats) {
        ASSERT_EQ(found[i + 3], found[i + 2] * std::min(found[i] + found[i + 1], 1.0F));
    }
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LT(off.at(k), 1e-4) << k;
        EXPECT_GT(between.at(k), 15U) << k << ": few compare anything";
    }
    EXPECT_LT(skipped, count / 10);
    RecordProperty("off", std::to_string(*std::max_element(off.begin(), off.end())));
}

TEST_F(SimulationWhitewater, OfAFluidThatMovesAsOneIsItsEnergyAloneAndWrongRangesAreNamed) {
    SimulationSettings settings;
    settings.gravity = {0, 0, 0};
    settings.viscosity = 0.0F;
    const std::vector<float> positions = lattice({-0.3F, 0.5F, -0.3F}, 6, 6, 6, 0.045F, 0.0F, 1);
    std::vector<float> velocities;
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        velocities.insert(velocities.end(), {0.0F, 6.0F, 0.0F});
    }
    const auto solver = make(settings, positions, velocities);
    ASSERT_TRUE(solver->step(1.0 / 1024.0).ok());
    const std::vector<float> found = potentials(*solver, {}, positions.size() / 3);
    for (std::size_t i = 0; i < found.size(); i += kWhitewaterFloats) {
        ASSERT_EQ(found[i], 0.0F);
        ASSERT_NEAR(found[i + 2], (18.0 - 5.0) / 45.0, 1e-3);
        ASSERT_EQ(found[i + 3], 0.0F) << "no air, no crest: nothing turns white";
    }
    Whitewater wrong;
    wrong.crest = {3.0F, 3.0F};
    const Status status = solver->whitewater(wrong, VK_NULL_HANDLE);
    ASSERT_FALSE(status.ok());
    EXPECT_THAT(status.error().message(), HasSubstr("3 to 3 is no range"));
}

TEST_F(SimulationWhitewater, FoamIsWhatTurnsWhiteNowOrWhatIsLeftOfIt) {
    SimulationSettings settings;
    settings.radius = 0.02F;
    settings.low = {0, 0, 0};
    settings.high = {0.8F, 1, 0.6F};
    const std::vector<float> positions = lattice({0.1F, 0.05F, 0.1F}, 6, 6, 6, 0.04F, 0.008F, 4);
    Dice dice(6);
    std::vector<float> velocities;
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        velocities.insert(velocities.end(), {dice.between(-2, 2), dice.between(-2, 2), dice.between(-2, 2)});
    }
    const auto solver = make(settings, positions, velocities);
    const Whitewater how{{0.1F, 10.0F}, {0.1F, 3.0F}, {0.05F, 2.0F}};
    const std::size_t floats = kWhitewaterFloats * positions.size() / 3;
    const auto age = FoamAge::create(device()).value();
    std::vector<double> expected(positions.size() / 3);
    const float kept = 0.75F;
    std::size_t faded = 0;
    for (int step = 0; step < 6; ++step) {
        ASSERT_TRUE(solver->step(1.0 / 128.0).ok());
        const std::vector<float> now = potentials(*solver, how, positions.size() / 3);
        const std::vector<float> found = filled(floats, -1.0F, [&](VkBuffer to) {
            const Status made = solver->whitewater(how, to);
            return made ? age->age(solver->onDevice(), to, {}, kept) : made;
        });
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const auto turns = double{now[kWhitewaterFloats * i + 3]};
            faded += expected[i] * double{kept} > turns ? 1U : 0U;
            expected[i] = std::max(turns, expected[i] * double{kept});
            ASSERT_NEAR(double{found[kWhitewaterFloats * i + 3]}, expected[i], 1e-6);
            ASSERT_EQ(found[kWhitewaterFloats * i], now[kWhitewaterFloats * i]);
        }
    }
    EXPECT_GT(faded, 50U);
    EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0.01);
    age->forget();
    const std::vector<float> now = potentials(*solver, how, positions.size() / 3);
    EXPECT_EQ(filled(floats, -1.0F,
                     [&](VkBuffer to) {
                         const Status made = solver->whitewater(how, to);
                         return made ? age->age(solver->onDevice(), to, {}, kept) : made;
                     }),
              now);
}

}  // namespace
}  // namespace sluice::vk::test
