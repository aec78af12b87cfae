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

TEST_F(SimulationSeenPool, WaterAtRestInATroughThatIsSeenStaysAtRest) {
    constexpr std::uint32_t kWidth = 320;
    constexpr std::uint32_t kHeight = 240;
    const Solid pillar = boxSolid({0.4F, 0.2F, 0.34F}, {0.06F, 0.2F, 0.06F});
    DepthView camera = looking({0.9, 0.95, 1.6}, {0.3, 0.1, 0.3}, kWidth, kHeight);
    camera.projection[0] = 1.44F;
    camera.projection[5] = 1.92F;
    // Walls of three radii stand around the domain, so that they hide water and hold none.
    const DepthField full = picture(
        camera, kWidth, kHeight,
        {planeSolid({0, 1, 0}, {0, 0, 0}), boxSolid({0.3F, 0.1F, -0.03F}, {0.36F, 0.1F, 0.03F}),
         boxSolid({0.3F, 0.1F, 0.63F}, {0.36F, 0.1F, 0.03F}), boxSolid({-0.03F, 0.1F, 0.3F}, {0.03F, 0.1F, 0.3F}),
         boxSolid({0.63F, 0.1F, 0.3F}, {0.03F, 0.1F, 0.3F}), pillar});
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
    EXPECT_LT(seen.energy, 4.0 * solid.energy);
    EXPECT_LT(only_seen.energy, 8.0 * solid.energy);
    EXPECT_LT(std::max(seen.highest, only_seen.highest), 0.16F) << "of 0.12 m; droplets leap";
}

}  // namespace
}  // namespace sluice::vk::test
