// SPDX-License-Identifier: MIT
// Several fluids inside the renderer (ABI 1.3): the solver's own bits, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "core_live_rig.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kValues = 5;

class LiveFluids : public LiveFluid {
  protected:
    SluiceResult setFlow(const SluiceFlow& flow) {
        said = sized<SluiceError>();
        return api().set_flow(renderer->get(), &flow, &said);
    }
    std::string refused(const Block& block) {
        said = sized<SluiceError>();
        EXPECT_EQ(api().set_simulation(renderer->get(), &block.simulation, &said), SLUICE_ERROR_INVALID_ARGUMENT);
        return {&said.message[0]};
    }
};

/// Water over oil, and oil from a tap.
struct Oily : Block {
    explicit Oily(std::uint32_t frames_in_flight = 1) : Block(frames_in_flight) {
        for (std::size_t i = 0; i < position.size() / 3; ++i) {
            fluid.push_back(i / 6 % 8 < 4 ? 1 : 0);
        }
        kinds[0] = {1.0F, 0.02F, 0.1F, 0.05F, {}};
        kinds[1] = {0.25F, 0.3F, 0.0F, 0.0F, {}};
        settings.fluids = {{1.0F, 0.02F, 0.1F, 0.05F}, {0.25F, 0.3F, 0.0F, 0.0F}};
        simulation.fluids = kinds.data();
        simulation.fluid_count = 2;
        simulation.particle_fluids = fluid.data();
        simulation.particle_fluid_count = static_cast<std::uint32_t>(fluid.size());
        tap.shape = SLUICE_OPENING_DISC;
        tap.centre[1] = 0.7F;
        tap.centre[2] = -2.0F;
        tap.direction[1] = -1.0F;
        tap.width = tap.height = 0.2F;
        tap.speed = 3.0F;
        tap.fluid = 1;
        simulation.emitters = &tap;
        simulation.emitter_count = 1;
        simulation.max_particles = settings.sources.most_particles = 1000;
        settings.sources.emitters = {{true, {0, 0.7F, -2.0F}, {0, -1, 0}, 0.2F, 0.2F, 3.0F, 0.0F, 0.0F, 0.0F, 1}};
    }
    /// What it begins with.
    [[nodiscard]] SluiceFlow flow() const {
        auto out = sized<SluiceFlow>();
        out.iterations = simulation.iterations;
        std::copy_n(&simulation.gravity[0], 3, &out.gravity[0]);
        out.viscosity = simulation.viscosity;
        out.emitter_count = 1;
        out.emitters[0] = tap;
        out.fluid_count = 2;
        std::copy(kinds.begin(), kinds.end(), &out.fluids[0]);
        return out;
    }
    std::array<SluiceFluidKind, 2> kinds{};
    SluiceEmitter tap{};
};

TEST_F(LiveFluids, AreTheSolversOwnToTheBitForEveryNumberOfFramesInFlight) {
    const Oily oily;
    ASSERT_NO_FATAL_FAILURE(start(oily));
    const auto pictures = uploaded(oily, kValues);
    for (const std::uint32_t in_flight : {1U, 3U}) {
        ASSERT_NO_FATAL_FAILURE(expectPictures(Oily(in_flight), pictures));
    }
    // As one they flow otherwise; without their numbers all are of the first.
    Oily first;
    first.simulation.particle_fluid_count = 0;
    first.fluid.clear();
    ASSERT_NO_FATAL_FAILURE(start(first));
    const auto alike = uploaded(first, kValues);
    EXPECT_EQ(alike.front(), pictures.front());
    EXPECT_NE(alike.back(), pictures.back());
    ASSERT_NO_FATAL_FAILURE(expectPictures(first, alike));
}

TEST_F(LiveFluids, OneOfThemFlowsOtherwiseFromTheNextValueOn) {
    Oily oily;
    std::uint64_t value = 0;
    oily.seen = [&](Solver& solver) {
        if (++value == 2) {
            FlowSettings to;
            to.emitters = oily.settings.sources.emitters;
            to.emitters[0].fluid = 0;
            to.fluids = oily.settings.fluids;
            to.fluids[1].viscosity = 0.9F;
            to.fluids[1].tension = 2.0F;
            EXPECT_TRUE(solver.setFlow(to));
        }
    };
    ASSERT_NO_FATAL_FAILURE(start(oily));
    const auto pictures = uploaded(oily, kValues);
    ASSERT_NO_FATAL_FAILURE(start(oily));
    SluiceFlow flow = oily.flow();
    flow.emitters[0].fluid = 0;
    flow.fluids[1].viscosity = 0.9F;
    flow.fluids[1].tension = 2.0F;
    for (std::uint64_t k = 1; k <= kValues; ++k) {
        if (k == 3) {
            ASSERT_EQ(setFlow(flow), SLUICE_OK) << said.message;
        } else if (k == 4) {  // without a list all fluids flow on as they did
            SluiceFlow rest = flow;
            rest.fluid_count = 0;
            rest.viscosity = 1.0F;  // of the one fluid that there is not
            ASSERT_EQ(setFlow(rest), SLUICE_OK) << said.message;
        }
        ASSERT_EQ(simulate(k, k == 1 ? 0.0 : kFrame), SLUICE_OK);
        EXPECT_EQ(draw(k, k), pictures[k - 1]) << "value " << k;
    }
    EXPECT_EQ(stats().failed, 0U) << stats().message;

    const auto wrong = [&](auto change) {
        SluiceFlow changed = flow;
        change(changed);
        EXPECT_EQ(setFlow(changed), SLUICE_ERROR_INVALID_ARGUMENT);
        return std::string(&said.message[0]);
    };
    EXPECT_THAT(wrong([](SluiceFlow& f) { f.fluid_count = 1; }), HasSubstr("fluids: expected the 2 that it began"));
    EXPECT_THAT(wrong([](SluiceFlow& f) { f.fluid_count = 9; }), HasSubstr("flow.fluids: expected at most 8, found 9"));
    EXPECT_THAT(wrong([](SluiceFlow& f) { f.fluids[1].density = 0.5F; }),
                HasSubstr("fluid 1: density: expected the 0.25"));
    EXPECT_THAT(wrong([](SluiceFlow& f) { f.fluids[1].viscosity = 1.5F; }), HasSubstr("fluid 1: viscosity"));
    EXPECT_THAT(wrong([](SluiceFlow& f) { f.emitters[0].fluid = 2; }),
                HasSubstr("emitter 0: expected a fluid below 2"));
    EXPECT_EQ(simulate(kValues + 1, kFrame), SLUICE_OK);
}

TEST_F(LiveFluids, AListOfOneOfDensityOneIsNoneAndItsFlowMayChange) {
    Block block;
    block.seen = [&](Solver& solver) {
        FlowSettings to;
        to.viscosity = 0.5F;
        EXPECT_TRUE(solver.setFlow(to));
    };
    ASSERT_NO_FATAL_FAILURE(start(block));
    const auto pictures = uploaded(block, 3);
    SluiceFluidKind water{1.0F, block.simulation.viscosity, 0.0F, 0.0F, {}};
    block.simulation.fluids = &water;
    block.simulation.fluid_count = 1;
    block.simulation.viscosity = 0.9F;  // the list's counts
    ASSERT_NO_FATAL_FAILURE(start(block));
    auto flow = sized<SluiceFlow>();
    flow.iterations = 4;
    flow.gravity[1] = -9.81F;
    flow.fluid_count = 1;
    flow.fluids[0] = water;
    flow.fluids[0].viscosity = 0.5F;
    for (std::uint64_t k = 1; k <= 3; ++k) {
        ASSERT_EQ(simulate(k, k == 1 ? 0.0 : kFrame), SLUICE_OK);
        ASSERT_EQ(setFlow(flow), SLUICE_OK) << said.message;
        EXPECT_EQ(draw(k, k), pictures[k - 1]) << "value " << k;
    }
    ASSERT_NO_FATAL_FAILURE(start(Block()));
    EXPECT_EQ(setFlow(flow), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(said.message, HasSubstr("fluids: expected the 0 that it began with, found 1"));
}

TEST_F(LiveFluids, AResetNamesThemAnew) {
    Oily turned;
    for (std::uint32_t& fluid : turned.fluid) {
        fluid = 1 - fluid;
    }
    others = {{{0.1F, 2.0F, 8.0F}, {}}};
    scatter = 0.5F;
    ASSERT_NO_FATAL_FAILURE(start(turned));
    const auto pictures = uploaded(turned, 3);
    const Oily oily;
    ASSERT_NO_FATAL_FAILURE(start(oily));
    ASSERT_EQ(simulate(1, 0.0), SLUICE_OK);
    EXPECT_NE(draw(1, 1), pictures.front());
    auto to = sized<SluiceStart>();
    to.particle_count = turned.simulation.particle_count;
    to.position = turned.position.data();
    to.particle_fluids = turned.fluid.data();
    ASSERT_EQ(api().reset_simulation(renderer->get(), &to, &said), SLUICE_OK) << said.message;
    for (std::uint64_t k = 2; k <= 4; ++k) {
        ASSERT_EQ(simulate(k, k == 2 ? 0.0 : kFrame), SLUICE_OK);
        EXPECT_EQ(draw(k, k), pictures[k - 2]) << "value " << k;
    }
    turned.fluid[3] = 2;
    EXPECT_EQ(api().reset_simulation(renderer->get(), &to, &said), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(said.message, HasSubstr("particle 3: expected a fluid below 2, found 2"));
}

/// Who goes leaves a gap: a number in the wrong place would be a colour in the wrong place.
TEST_F(LiveFluids, LookEachItsOwnAsTheSolversParticlesDoWhenTheyAreGiven) {
    Oily oily(2);
    SluiceDrain drain{};
    drain.shape = SLUICE_REGION_BOX;
    drain.centre[1] = -0.25F;
    drain.centre[2] = -2.0F;
    drain.half[0] = 0.1F;
    drain.half[1] = 0.15F;
    drain.half[2] = 0.5F;
    oily.simulation.drains = &drain;
    oily.simulation.drain_count = 1;
    oily.settings.sources.drains = {{false, {0, -0.25F, -2.0F}, {0.1F, 0.15F, 0.5F}}};
    scatter = 0.5F;
    ASSERT_NO_FATAL_FAILURE(start(oily));
    const auto alike = uploaded(oily, 3);
    others = {{{0.1F, 2.0F, 8.0F}, {}}};
    ASSERT_NO_FATAL_FAILURE(start(oily));
    const auto apart = uploaded(oily, 3);
    EXPECT_NE(apart[0], alike[0]);
    ASSERT_NO_FATAL_FAILURE(expectPictures(oily, apart));
    EXPECT_NE(stats().particle_count, oily.simulation.particle_count);
    // The same look for all is one look, whatever is said of it; so are particles of one fluid.
    const SluiceFluid& look = frameOf(1, 2, SLUICE_VIEW_FLUID).fluid;
    others = {{{look.absorption[0], look.absorption[1], look.absorption[2]}, {}}};
    ASSERT_NO_FATAL_FAILURE(expectPictures(oily, alike));
    others = {{{0.1F, 2.0F, 8.0F}, {}}};
    ASSERT_NO_FATAL_FAILURE(start(Block()));
    const auto one = uploaded(Block(), 1);
    others.clear();
    ASSERT_NO_FATAL_FAILURE(expectPictures(Block(), one));

    SluiceFrame frame = frameOf(2, 2, SLUICE_VIEW_FLUID);
    frame.other_look_count = SLUICE_MAX_FLUIDS;
    EXPECT_EQ(renderer->submit(frame), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(renderer->error().message, HasSubstr("other_look_count: 8 is above 7"));
    frame.other_look_count = 1;
    frame.other_looks[0].absorption[2] = -1.0F;
    EXPECT_EQ(renderer->submit(frame), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(renderer->error().message, HasSubstr("other_looks[0].absorption: -1 is outside"));
    const ParticleCloud cloud(3);
    SluiceParticles particles = cloud.particles;
    const std::array<std::uint32_t, 3> fluids{0, 7, 8};
    particles.fluid = fluids.data();
    EXPECT_EQ(api().set_particles(renderer->get(), &particles, &said), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(said.message, HasSubstr("particles.fluid[2]: 8 is above 7"));
}

TEST_F(LiveFluids, WhatIsWrongIsRefusedByName) {
    ASSERT_NO_FATAL_FAILURE(start(Block()));
    const auto wrong = [&](auto change) {
        Oily oily;
        change(oily);
        return refused(oily);
    };
    EXPECT_THAT(wrong([](Oily& o) { o.simulation.fluid_count = 9; }), HasSubstr("fluids: expected at most 8, found 9"));
    EXPECT_THAT(wrong([](Oily& o) { o.simulation.fluids = nullptr; }), HasSubstr("fluids: expected at most 8"));
    EXPECT_THAT(wrong([](Oily& o) { o.simulation.particle_fluids = nullptr; }), HasSubstr("particle_fluids"));
    EXPECT_THAT(wrong([](Oily& o) { o.simulation.particle_fluid_count -= 1; }),
                HasSubstr("particle_fluids: expected one for each of 288 particles, or none, found 287"));
    EXPECT_THAT(wrong([](Oily& o) { o.fluid[7] = 2; }), HasSubstr("particle 7: expected a fluid below 2, found 2"));
    EXPECT_THAT(wrong([](Oily& o) { o.simulation.fluid_count = 0; }), HasSubstr("emitter 0: expected a fluid below 1"));
    EXPECT_THAT(wrong([](Oily& o) { o.tap.fluid = 2; }), HasSubstr("emitter 0: expected a fluid below 2, found 2"));
    EXPECT_THAT(wrong([](Oily& o) { o.kinds[1].density = std::numeric_limits<float>::quiet_NaN(); }),
                HasSubstr("fluid 1: density"));
    EXPECT_THAT(wrong([](Oily& o) { o.kinds[0].density = 5.0F; }), HasSubstr("at most 16 times as dense"));
    // A host of 1.2 has none of it.
    Oily older;
    older.tap.fluid = 0;
    older.simulation.struct_size = 256;
    EXPECT_EQ(api().set_simulation(renderer->get(), &older.simulation, &said), SLUICE_OK) << said.message;
}

}  // namespace
}  // namespace sluice::vk::test
