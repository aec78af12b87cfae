// SPDX-License-Identifier: MIT
// A pool at rest in a trough that a camera sees stays at rest: among them water hidden behind the trough's front.
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "seen_rig.hpp"
#include "simulation_rig.hpp"

namespace sluice::vk::test {
namespace {

class SimulationSeenPool : public SimulationTest {};

constexpr std::uint32_t kWidth = 320;
constexpr std::uint32_t kHeight = 240;

DepthView cameraAt(const Vector& eye, const Vector& target, const Vector& upward) {
    DepthView camera = looking(eye, target, kWidth, kHeight, upward);
    camera.projection[0] = 1.44F;
    camera.projection[5] = 1.92F;
    return camera;
}

/// A floor and walls of three radii about a square of 0.6 m.
std::vector<Solid> trough() {
    return {planeSolid({0, 1, 0}, {0, 0, 0}), boxSolid({0.3F, 0.1F, -0.03F}, {0.36F, 0.1F, 0.03F}),
            boxSolid({0.3F, 0.1F, 0.63F}, {0.36F, 0.1F, 0.03F}), boxSolid({-0.03F, 0.1F, 0.3F}, {0.03F, 0.1F, 0.3F}),
            boxSolid({0.63F, 0.1F, 0.3F}, {0.03F, 0.1F, 0.3F})};
}

TEST_F(SimulationSeenPool, WaterAtRestInATroughThatIsSeenStaysAtRest) {
    const Solid pillar = boxSolid({0.4F, 0.2F, 0.34F}, {0.06F, 0.2F, 0.06F});
    const DepthView camera = cameraAt({0.9, 0.95, 1.6}, {0.3, 0.1, 0.3}, {0, 1, 0});
    // The walls stand around the domain, so that they hide water and hold none.
    std::vector<Solid> solids = trough();
    solids.push_back(pillar);
    const DepthField full = picture(camera, kWidth, kHeight, solids);
    std::vector<float> pool;
    const std::vector<float> all = lattice({0, 0, 0}, 15, 3, 15, 2.0F * kRadius, 0.0F, 1);
    for (std::size_t i = 0; i < all.size(); i += 3) {
        if (distanceTo(pillar, {all[i], all[i + 1], all[i + 2]}) > double{kRadius}) {
            pool.insert(pool.end(), {all[i], all[i + 1], all[i + 2]});
        }
    }
    /// Kinetic energy of a particle after 1 s, and how high one has ever been.
    struct Outcome {
        double energy = 0.0;
        float highest = 0.0F;
    };
    const auto outcome = [&](std::uint32_t scale, bool pillar_is_solid) {
        SimulationSettings settings;
        settings.radius = kRadius;
        settings.low = {0, 0, 0};
        settings.high = {0.6F, 0.6F, 0.6F};
        if (pillar_is_solid) {
            settings.solids = {pillar};
        }
        if (scale > 0) {
            settings.seen = std::make_shared<const DepthField>(
                depthField(camera, kWidth, kHeight, scale, kThicknessInRadii * kRadius, full.depth));
        }
        const auto solver = make(settings, pool);
        Outcome result;
        for (int tenth = 0; tenth < 10; ++tenth) {
            EXPECT_TRUE(solver->advance(0.1, 1.0 / 120.0).ok());
            const ParticleState state = solver->read().value();
            result.energy = 0.5 * squares(state.velocity) / static_cast<double>(solver->count());
            for (std::size_t i = 1; i < state.position.size(); i += 3) {
                result.highest = std::max(result.highest, state.position[i]);
            }
        }
        return result;
    };
    const Outcome solid = outcome(0, true);
    const Outcome seen = outcome(4, true);
    const Outcome only_seen = outcome(4, false);  // water finds its level where the pillar is hidden by itself
    RecordProperty("energies", fmt::format("{:.4f} {:.4f} {:.4f} J/kg", solid.energy, seen.energy, only_seen.energy));
    RecordProperty("highest", fmt::format("{} {} {}", solid.highest, seen.highest, only_seen.highest));
    EXPECT_LT(seen.energy, 2.0 * solid.energy);
    EXPECT_LT(only_seen.energy, 5.0 * solid.energy);
    EXPECT_LT(std::max(seen.highest, only_seen.highest), 0.15F) << "of 0.12 m; droplets leap";
}

TEST_F(SimulationSeenPool, NobodyWhoIsSeenGetsOutOfATroughThatNothingElseHolds) {
    // No solids, and a domain that is larger on all sides and below.
    SimulationSettings settings;
    settings.radius = kRadius;
    settings.low = {-0.4F, -0.2F, -0.4F};
    settings.high = {1.0F, 0.6F, 1.0F};
    const std::vector<float> pool = lattice({0, 0, 0}, 15, 3, 15, 2.0F * kRadius, 0.0F, 1);
    struct Look {
        Vector eye, target, upward;
        double out, energy;  ///< share of who began where it is seen; J/kg after 1 s
    };
    for (const Look& look : {Look{{0.3, 1.6, 0.3}, {0.3, 0, 0.3}, {0, 0, -1}, 0.005, 0.012},     // into it
                             Look{{0.5, 1.4, 1.0}, {0.3, 0.05, 0.3}, {0, 1, 0}, 0.03, 0.03}}) {  // over its front
        const DepthView camera = cameraAt(look.eye, look.target, look.upward);
        const DepthField full = picture(camera, kWidth, kHeight, trough());
        settings.seen = std::make_shared<const DepthField>(depthField(camera, kWidth, kHeight, 4, 10.0F, full.depth));
        const auto solver = make(settings, pool);
        std::size_t seen = 0;
        std::size_t out = 0;
        ASSERT_TRUE(solver->advance(1.0, 1.0 / 120.0).ok());
        const ParticleState state = solver->read().value();
        const std::vector<Vector> before = vectorsOf(pool);
        const std::vector<Vector> after = vectorsOf(state.position);
        for (std::size_t i = 0; i < after.size(); ++i) {
            if (reference::hiddenIn(*settings.seen, double{kRadius}, before[i])) {
                continue;
            }
            ++seen;
            const Vector& x = after[i];
            out += x[0] < -0.05 || x[0] > 0.65 || x[2] < -0.05 || x[2] > 0.65 || x[1] < -0.032 ? 1U : 0U;
        }
        const double energy = 0.5 * squares(state.velocity) / static_cast<double>(after.size());
        RecordProperty(fmt::format("from_{}", look.eye[2]), fmt::format("{} of {}; {:.4f} J/kg", out, seen, energy));
        EXPECT_GT(seen, after.size() / 2);
        EXPECT_LT(static_cast<double>(out), look.out * static_cast<double>(seen));
        EXPECT_LT(energy, look.energy);
    }
}

}  // namespace
}  // namespace sluice::vk::test
