// SPDX-License-Identifier: MIT
// Emitters, drains and force fields: the numbers that they promise, and that nothing else changes.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "reference/simulation_reference.hpp"
#include "simulation_rig.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

class SimulationSources : public SimulationTest {};

double nearestPair(const std::vector<float>& triples) {
    const std::vector<Vec> x = vectorsOf(triples);
    double nearest = 1e300;
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            nearest = std::min(nearest, apart(x[i], x[j]));
        }
    }
    return nearest;
}

Emitter tap(const Triple& centre, float width, float speed) {
    Emitter emitter;
    emitter.centre = centre;
    emitter.width = width;
    emitter.height = width;
    emitter.speed = speed;
    return emitter;
}

TEST(Outlet, HoldsALatticeThatKeepsHalfARadiusFromItsRim) {
    Emitter emitter = tap({1, 2, 3}, 0.2F, 1);
    emitter.direction = {1, 1, 0};
    const std::vector<Triple> disc = outletSites(emitter, 0.02F);
    EXPECT_EQ(disc.size(), 21U);  // of 5 by 5, without the corners
    emitter.disc = false;
    emitter.height = 0.08F;
    const std::vector<Triple> slot = outletSites(emitter, 0.02F);
    EXPECT_EQ(slot.size(), 10U);
    for (const auto* sites : {&disc, &slot}) {
        std::vector<float> triples;
        for (const Triple& site : *sites) {
            triples.insert(triples.end(), site.begin(), site.end());
            EXPECT_NEAR(site[0] - 1 + (site[1] - 2), 0.0, 1e-6) << "in the plane of the opening";
        }
        EXPECT_NEAR(nearestPair(triples), 0.04, 1e-6);
    }
    EXPECT_EQ(outletSites(tap({}, 0.001F, 1), 0.02F).size(), 1U);
}

TEST(Births, AreTheSameHoweverTimeIsCut) {
    Emitter emitter = tap({0, 1, 0}, 0.1F, 1.7F);
    emitter.start = 0.05F;
    emitter.stop = 0.6F;
    const std::vector<Triple> sites = outletSites(emitter, 0.02F);
    Dice dice(11);
    std::vector<Birth> parts;
    std::vector<double> arrivals;  // when each was at the opening
    double time = 0.0;
    while (time < 0.7) {
        const double next = time + double{dice.between(0.0001F, 0.02F)};
        std::vector<Birth> some;
        addBirths(emitter, sites, 0.02F, {0, 0, 0}, time, next, some);
        for (const Birth& birth : some) {
            arrivals.push_back(next - (1.0 - double{birth.position[1]}) / 1.7);
            parts.push_back(birth);
        }
        time = next;
    }
    const double period = 0.04 / 1.7;
    EXPECT_EQ(parts.size(), sites.size() * static_cast<std::size_t>(std::ceil(0.55 / period)));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        EXPECT_NEAR(arrivals[i], 0.05 + period * static_cast<double>(i / sites.size()), 1e-6);
    }
}

TEST_F(SimulationSources, AJetHasTheRateAndTheSpacingThatWereAskedFor) {
    SimulationSettings settings;
    settings.gravity = {0, 0, 0};
    settings.low = {-1, -1, -1};
    settings.high = {1, 3, 1};
    Emitter emitter = tap({0, 2.5F, 0}, 0.2F, 1.5F);
    settings.sources.emitters = {emitter};
    const auto solver = make(settings, {});
    EXPECT_EQ(solver->count(), 0U);
    const auto report = solver->advance(1.0, 1.0 / 60.0);
    ASSERT_TRUE(report.ok()) << report.error().message();
    // 21 at a time, 0.04 m apart at 1.5 m/s: 38 layers in a second.
    EXPECT_EQ(report.value().born, 38U * 21U);
    EXPECT_EQ(report.value().blocked, 0U);
    EXPECT_EQ(solver->count(), 38U * 21U);
    EXPECT_NEAR(solver->time(), 1.0, 1e-9);
    const auto state = solver->read();
    ASSERT_TRUE(state.ok());
    EXPECT_GT(nearestPair(state.value().position), 0.0385);
    EXPECT_NEAR(report.value().speed, 1.5, 0.01) << "nobody was thrown out";
    for (std::size_t i = 3 * 21; i < state.value().position.size(); i += 3) {
        ASSERT_NEAR(state.value().position[i + 1 - 3 * 21] - state.value().position[i + 1], -0.04, 5e-3)
            << "the order is that of birth, first layers first";
    }

    emitter.rate = 210.0F;
    emitter.start = 0.05F;
    settings.sources.emitters = {emitter};
    const auto slow = make(settings, {})->advance(1.0, 1.0 / 60.0);
    ASSERT_TRUE(slow.ok());
    EXPECT_EQ(slow.value().born, 210U);
}

TEST_F(SimulationSources, ATapUnderWaterStopsInsteadOfPressingMoreIntoAFullBox) {
    SimulationSettings settings;
    settings.low = {0, 0, 0};
    settings.high = {0.4F, 0.4F, 0.4F};
    settings.sources.emitters = {tap({0.2F, 0.35F, 0.2F}, 0.16F, 2.0F)};
    const auto solver = make(settings, lattice({0, 0, 0}, 10, 8, 10, 0.04F, 0.0F, 1));
    AdvanceReport last;
    for (int i = 0; i < 4; ++i) {
        const auto report = solver->advance(0.25, 1.0 / 60.0);
        ASSERT_TRUE(report.ok()) << report.error().message();
        last = report.value();
    }
    EXPECT_GT(last.blocked, 0U);
    EXPECT_GT(solver->count(), 850U);
    EXPECT_LT(solver->count(), 1100U) << "1000 fill the box";
    const auto densities = solver->densities();
    ASSERT_TRUE(densities.ok());
    EXPECT_LT(*std::max_element(densities.value().begin(), densities.value().end()), 1.5F);
}

TEST_F(SimulationSources, ADrainTakesExactlyWhoIsInItAndTheOrderStays) {
    SimulationSettings settings;
    settings.gravity = {0, 0, 0};
    settings.sources.drains = {{true, {0.5F, 0.5F, 0.5F}, {0.3F, 0.3F, 0.3F}},
                               {false, {-0.5F, 0.5F, -0.5F}, {0.2F, 0.1F, 0.3F}}};
    // Out of each other's reach, so that only the drains act.
    const std::vector<float> positions = lattice({-0.9F, 0.1F, -0.9F}, 18, 10, 18, 0.1F, 0.0F, 1);
    std::vector<float> expected;
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        const Vec x{double{positions[i]}, double{positions[i + 1]}, double{positions[i + 2]}};
        const bool in_box = std::abs(x[0] + 0.5) < 0.2 && std::abs(x[1] - 0.5) < 0.1 && std::abs(x[2] + 0.5) < 0.3;
        if (apart(x, {0.5, 0.5, 0.5}) >= 0.3 && !in_box) {
            expected.insert(expected.end(), positions.begin() + static_cast<std::ptrdiff_t>(i),
                            positions.begin() + static_cast<std::ptrdiff_t>(i) + 3);
        }
    }
    const auto solver = make(settings, positions);
    const auto first = solver->step(0.001);
    ASSERT_TRUE(first.ok()) << first.error().message();
    EXPECT_EQ(first.value().drained, (positions.size() - expected.size()) / 3);
    EXPECT_EQ(solver->count(), expected.size() / 3);
    EXPECT_EQ(solver->read().value().position, expected);
    for (int i = 0; i < 3; ++i) {
        const auto next = solver->step(0.001);
        ASSERT_TRUE(next.ok());
        EXPECT_EQ(next.value().drained, 0U);
    }
    EXPECT_EQ(solver->read().value().position, expected);
    EXPECT_EQ(solver->densities().value().size(), expected.size() / 3);
    EXPECT_THAT(solver->lists().error().message(), HasSubstr("particles that stay"));
}

TEST_F(SimulationSources, ABasinWithTapAndDrainGivesTheSameBitsTwiceAndNobodyIsLost) {
    SimulationSettings settings;
    settings.low = {0, 0, 0};
    settings.high = {0.6F, 0.8F, 0.6F};
    settings.sources.emitters = {tap({0.15F, 0.6F, 0.15F}, 0.2F, 1.0F)};
    settings.sources.emitters[0].direction = {0.5F, -1, 0.3F};
    settings.sources.drains = {{false, {0.5F, 0.05F, 0.5F}, {0.1F, 0.05F, 0.1F}}};
    const std::vector<float> positions = lattice({0, 0, 0}, 15, 3, 15, 0.04F, 0.002F, 3);
    const auto run = [&](bool twice) {
        const auto solver = make(settings, positions);
        if (twice) {  // what was there before leaves no trace, nor does the room that it took
            EXPECT_TRUE(solver->setParticles(lattice({0, 0, 0}, 15, 12, 15, 0.04F, 0.0F, 1), {}).ok());
            EXPECT_TRUE(solver->advance(0.1, 0.01).ok());
            EXPECT_TRUE(solver->setParticles(positions, {}).ok());
        }
        AdvanceReport total;
        for (int i = 0; i < 6; ++i) {
            const auto report = solver->advance(0.1, 1.0 / 60.0);
            EXPECT_TRUE(report.ok()) << report.error().message();
            total.born += report.value().born;
            total.drained += report.value().drained;
        }
        EXPECT_GT(total.born, 300U);
        EXPECT_GT(total.drained, 100U);
        EXPECT_EQ(solver->count(), positions.size() / 3 + total.born - total.drained);
        return solver->read().value();
    };
    const ParticleState first = run(false);
    const ParticleState second = run(true);
    EXPECT_EQ(first.position, second.position);
    EXPECT_EQ(first.velocity, second.velocity);
}

TEST_F(SimulationSources, FieldsMatchTheDoublePrecisionReference) {
    SimulationSettings settings;
    settings.low = {-1, -1, -1};
    settings.high = {1, 1, 1};
    settings.sources.fields = {{ForceKind::Wind, {0.2F, 0, 0}, {1, 2, 0}, 30.0F, 0.5F},
                               {ForceKind::Point, {0, 0.4F, 0}, {0, 1, 0}, 40.0F, 0.7F},
                               {ForceKind::Vortex, {0.05F, 0, 0.07F}, {0.2F, 1, 0}, 50.0F, 0.0F}};
    const std::vector<float> positions = lattice({-0.17F, -0.17F, -0.17F}, 9, 9, 9, 0.039F, 0.004F, 5);
    constexpr double kDt = 1.0 / 128.0;
    const auto solver = make(settings, positions);
    ASSERT_TRUE(solver->step(kDt).ok());
    const std::vector<Vec> x = vectorsOf(solver->read().value().position);
    const ReferenceState expected =
        referenceStep(settings, {vectorsOf(positions), std::vector<Vec>(positions.size() / 3), {}}, kDt);
    SimulationSettings calm = settings;
    calm.sources = {};
    const ReferenceState without =
        referenceStep(calm, {vectorsOf(positions), std::vector<Vec>(positions.size() / 3), {}}, kDt);
    double farthest = 0.0;
    double moved = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        farthest = std::max(farthest, apart(x[i], expected.position[i]));
        moved = std::max(moved, apart(expected.position[i], without.position[i]));
    }
    EXPECT_LT(farthest, 5e-5 * double{settings.radius});
    EXPECT_GT(moved, 0.2 * double{settings.radius}) << "the fields do something";
}

TEST(SimulationSourcesCheck, NamesWhatIsWrong) {
    const auto message = [](const auto& change) {
        SimulationSettings settings;  // x and z in [-1, 1], y in [0, 2]
        settings.sources.emitters = {tap({0, 1, 0}, 0.2F, 1.0F)};
        settings.sources.drains = {{true, {}, {1, 1, 1}}};
        settings.sources.fields = {ForceField{}};
        change(settings.sources);
        settings.solids = {sphereSolid({0.5F, 1, 0}, 0.3F)};
        const Status status = checkSettings(settings);
        return status.ok() ? std::string() : status.error().message();
    };
    EXPECT_EQ(message([](SourceSettings&) {}), "");
    EXPECT_THAT(message([](SourceSettings& s) { s.emitters[0].direction = {0, 0, 0}; }), HasSubstr("a direction of"));
    EXPECT_THAT(message([](SourceSettings& s) { s.emitters[0].height = 0.3F; }), HasSubstr("a diameter > 0 as width"));
    EXPECT_THAT(message([](SourceSettings& s) { s.emitters[0].speed = 0; }), HasSubstr("a speed in (0, 10000]"));
    EXPECT_THAT(message([](SourceSettings& s) { s.emitters[0].rate = 1e4F; }),
                HasSubstr("a rate in [0, 525] particles per second, which is 21 at a time"));
    EXPECT_THAT(message([](SourceSettings& s) { s.emitters[0].stop = -1; }), HasSubstr("a start >= 0 and a stop"));
    EXPECT_THAT(message([](SourceSettings& s) { s.emitters[0].centre[0] = 0.95F; }),
                HasSubstr("lies outside the domain"));
    EXPECT_THAT(message([](SourceSettings& s) { s.emitters[0].centre[0] = 0.3F; }), HasSubstr("lies in solid 0"));
    EXPECT_THAT(message([](SourceSettings& s) { s.drains[0].half[1] = 0; }), HasSubstr("drain 0: expected a finite"));
    EXPECT_THAT(message([](SourceSettings& s) { s.fields[0].strength = NAN; }), HasSubstr("a strength in"));
    EXPECT_THAT(message([](SourceSettings& s) { s.fields.resize(17); }), HasSubstr("fields: expected at most 16"));
}

}  // namespace
}  // namespace sluice::vk::test
