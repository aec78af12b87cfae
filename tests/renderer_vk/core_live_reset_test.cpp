// SPDX-License-Identifier: MIT
// A fluid inside the renderer that begins anew while it flows, from particles that the host gives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "core_live_rig.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kBefore = 3;  // values that flow before the reset
constexpr std::uint64_t kAfter = 3;

/// More particles than the block has, elsewhere and on their way.
struct Warm : Block {
    Warm() {
        position.clear();
        for (int i = 0; i < 7 * 7 * 7; ++i) {
            position.push_back(-0.3F + 0.061F * static_cast<float>(i % 7));
            position.push_back(0.1F + 0.061F * static_cast<float>(i / 7 % 7));
            position.push_back(-2.2F + 0.061F * static_cast<float>(i / 49));
            velocity.insert(velocity.end(), {1.0F, -0.5F, 0.01F * static_cast<float>(i)});
        }
        simulation.particle_count = static_cast<std::uint32_t>(position.size() / 3);
        simulation.position = position.data();
        simulation.velocity = velocity.data();
    }
    [[nodiscard]] SluiceStart start() const {
        auto to = sized<SluiceStart>();
        to.particle_count = simulation.particle_count;
        to.position = position.data();
        to.velocity = velocity.data();
        return to;
    }
};

class LiveReset : public LiveFluid {
  protected:
    SluiceResult reset(const SluiceStart* start) {
        said = sized<SluiceError>();
        return api().reset_simulation(renderer->get(), start, &said);
    }
    /// Values of a simulation that flows, is reset to `warm` and flows on, against those that began so.
    void expectFromReset(const Block& block, const SluiceStart& warm,
                         const std::vector<std::vector<std::byte>>& pictures) {
        const std::uint64_t ahead = block.simulation.frames_in_flight - 1;
        std::uint64_t asked = 0;
        for (std::uint64_t k = 1; k <= kBefore + pictures.size(); ++k) {
            for (; asked < std::min<std::uint64_t>(kBefore + pictures.size(), k + ahead); ++asked) {
                const bool begins = asked == kBefore;
                if (begins) {
                    ASSERT_EQ(reset(&warm), SLUICE_OK) << said.message;
                }
                ASSERT_EQ(simulate(asked + 1, begins || asked == 0 ? 0.0 : kFrame), SLUICE_OK) << said.message;
            }
            const std::vector<std::byte> picture = draw(k, k);
            if (k > kBefore) {
                EXPECT_EQ(picture, pictures[k - kBefore - 1]) << "value " << k << ", " << ahead << " ahead";
            }
        }
        EXPECT_EQ(stats().failed, 0U) << stats().message;
        EXPECT_EQ(frameStats(kBefore + pictures.size()).validation_messages, 0U);
    }
};

TEST_F(LiveReset, IsTheSolverStartedFromThoseParticlesToTheBit) {
    const Warm warm;
    ASSERT_NO_FATAL_FAILURE(start(warm));
    const auto pictures = uploaded(warm, kAfter);
    ASSERT_NE(pictures.front(), pictures.back());
    const SluiceStart to = warm.start();
    for (const std::uint32_t in_flight : {1U, 3U}) {
        Block block(in_flight);
        block.simulation.max_particles = 400;
        ASSERT_NO_FATAL_FAILURE(start(block));
        ASSERT_NO_FATAL_FAILURE(expectFromReset(block, to, pictures));
        EXPECT_EQ(stats().particle_count, 343U);
        EXPECT_EQ(frameStats(kBefore + kAfter).passes[0].elements, 343U);
    }
    // And back to fewer.
    const Block block;
    Warm large;
    large.simulation.max_particles = 400;
    auto few = sized<SluiceStart>();
    few.particle_count = block.simulation.particle_count;
    few.position = block.position.data();
    ASSERT_NO_FATAL_FAILURE(start(block));
    const auto of_block = uploaded(block, kAfter);
    ASSERT_NO_FATAL_FAILURE(start(large));
    ASSERT_NO_FATAL_FAILURE(expectFromReset(large, few, of_block));
    EXPECT_EQ(frameStats(kBefore + kAfter).passes[0].elements, block.simulation.particle_count);
}

/// Births, losses and bodies count from time 0 again.
TEST_F(LiveReset, BringsBackBodiesAndBeginsTheTimeOfEmittersAgain) {
    SluiceEmitter emitter{};
    emitter.shape = SLUICE_OPENING_DISC;
    emitter.centre[1] = 0.7F;
    emitter.centre[2] = -2.0F;
    emitter.direction[1] = -1.0F;
    emitter.width = emitter.height = 0.2F;
    emitter.speed = 3.0F;
    emitter.stop = 0.03F;
    SluiceDrain drain{};
    drain.shape = SLUICE_REGION_BOX;
    drain.centre[1] = -0.25F;
    drain.centre[2] = -2.0F;
    drain.half[0] = drain.half[1] = 0.1F;
    drain.half[2] = 0.5F;
    std::array<SluiceBody, 2> body{};
    body[0].shape = body[1].shape = SLUICE_SOLID_SPHERE;
    body[0].centre[0] = 0.3F;
    body[0].centre[1] = 0.4F;
    body[0].centre[2] = body[1].centre[2] = -2.0F;
    body[0].density = 0.5F;
    body[1].motion = SLUICE_BODY_DRIVEN;
    body[1].centre[0] = -0.35F;
    body[1].centre[1] = 0.4F;
    for (SluiceBody& each : body) {
        std::fill_n(&each.half[0], 3, 0.08F);
    }
    Block block;
    block.simulation.emitters = &emitter;
    block.simulation.drains = &drain;
    block.simulation.bodies = body.data();
    block.simulation.emitter_count = block.simulation.drain_count = 1;
    block.simulation.body_count = 2;
    block.simulation.max_particles = 1000;
    ASSERT_NO_FATAL_FAILURE(start(block));
    std::vector<std::vector<std::byte>> pictures;
    for (std::uint64_t k = 1; k <= kAfter; ++k) {
        ASSERT_EQ(simulate(k, k == 1 ? 0.0 : kFrame), SLUICE_OK) << said.message;
        pictures.push_back(draw(k, k));
    }
    const std::uint32_t living = stats().particle_count;
    EXPECT_NE(living, block.simulation.particle_count);
    ASSERT_NO_FATAL_FAILURE(start(block));
    auto target = sized<SluiceBodyTarget>();
    target.centre[0] = -0.2F;
    target.centre[1] = 0.6F;
    target.centre[2] = -2.0F;
    target.turn[3] = 1.0F;
    ASSERT_EQ(api().set_body(renderer->get(), 1, &target, &said), SLUICE_OK) << said.message;
    auto again = sized<SluiceStart>();
    again.particle_count = block.simulation.particle_count;
    again.position = block.position.data();
    ASSERT_NO_FATAL_FAILURE(expectFromReset(block, again, pictures));
    EXPECT_EQ(stats().particle_count, living);
    auto bodies = sized<SluiceBodies>();
    ASSERT_EQ(api().simulation_bodies(renderer->get(), 0, &bodies), SLUICE_OK);
    EXPECT_EQ(bodies.bodies[1].centre[0], -0.35F) << "where it was sent is forgotten";
    again.particle_count = 0;
    EXPECT_EQ(reset(&again), SLUICE_OK) << said.message;
}

TEST_F(LiveReset, LetsAFluidThatHadFailedFlowAgain) {
    Block block;
    std::vector<float> fast(block.position.size(), 0.0F);
    fast[0] = 1e7F;
    block.simulation.velocity = fast.data();
    ASSERT_NO_FATAL_FAILURE(start(block));
    ASSERT_EQ(simulate(1, 0.0), SLUICE_OK);
    const std::vector<std::byte> good = draw(1, 1);
    ASSERT_EQ(simulate(2, kFrame), SLUICE_OK);
    EXPECT_EQ(draw(2, 2), good);
    EXPECT_EQ(stats().failed, 2U);
    auto still = sized<SluiceStart>();
    still.particle_count = block.simulation.particle_count;
    still.position = block.position.data();
    ASSERT_EQ(reset(&still), SLUICE_OK) << said.message;
    ASSERT_EQ(simulate(3, kFrame), SLUICE_OK);
    EXPECT_NE(draw(3, 3), good) << "it falls, and no value stands for the start alone";
    EXPECT_EQ(stats().failed, 0U);
    EXPECT_EQ(stats().message[0], '\0');
    EXPECT_GE(stats().steps, 2U);
}

TEST_F(LiveReset, WhatIsWrongIsRefusedByNameAndAllFlowsOn) {
    const Block block;
    ASSERT_NO_FATAL_FAILURE(start(block));
    const auto pictures = uploaded(block, 2);
    ASSERT_NO_FATAL_FAILURE(start(block));
    ASSERT_EQ(simulate(1, 0.0), SLUICE_OK);
    EXPECT_EQ(draw(1, 1), pictures[0]);
    const auto refused = [&](auto change) {
        std::vector<float> position = block.position;
        std::vector<float> velocity(position.size());
        auto to = sized<SluiceStart>();
        to.particle_count = block.simulation.particle_count;
        to.position = position.data();
        to.velocity = velocity.data();
        change(to, position, velocity);
        EXPECT_EQ(reset(&to), SLUICE_ERROR_INVALID_ARGUMENT);
        return std::string(&said.message[0]);
    };
    using Floats = std::vector<float>;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(refused([](SluiceStart& to, Floats& /*x*/, Floats& /*v*/) { to.particle_count = 0; }),
                HasSubstr("expected 1 to 288 particles, found 0"));
    EXPECT_THAT(refused([](SluiceStart& to, Floats& x, Floats& /*v*/) {
                    x.resize(x.size() + 3);
                    to.particle_count += 1;
                    to.position = x.data();
                    to.velocity = nullptr;
                }),
                HasSubstr("found 289 (set_simulation makes room for max_particles)"));
    EXPECT_THAT(refused([](SluiceStart& to, Floats& /*x*/, Floats& /*v*/) { to.particle_count = UINT32_MAX; }),
                HasSubstr("start.position: expected at most"));
    EXPECT_THAT(refused([](SluiceStart& to, Floats& /*x*/, Floats& /*v*/) { to.position = nullptr; }),
                HasSubstr("at NULL"));
    EXPECT_THAT(refused([](SluiceStart& to, Floats& /*x*/, Floats& /*v*/) { to.struct_size = 23; }),
                HasSubstr("struct_size is 23"));
    EXPECT_THAT(refused([&](SluiceStart& /*to*/, Floats& x, Floats& /*v*/) { x[21] = nan; }),
                HasSubstr("particle 7: expected finite position and velocity"));
    EXPECT_THAT(refused([&](SluiceStart& /*to*/, Floats& /*x*/, Floats& v) { v[4] = nan; }), HasSubstr("particle 1:"));
    EXPECT_THAT(refused([](SluiceStart& /*to*/, Floats& x, Floats& /*v*/) { x[1] = 1.5F; }),
                HasSubstr("particle 0: expected a position in the domain"));
    EXPECT_THAT(refused([](SluiceStart& /*to*/, Floats& x, Floats& /*v*/) {
                    x[6] = 0.0F;
                    x[7] = -0.45F;
                    x[8] = -2.0F;
                }),
                HasSubstr("particle 2: expected a position outside solid 0"));
    EXPECT_EQ(reset(nullptr), SLUICE_ERROR_INVALID_ARGUMENT);
    ASSERT_EQ(simulate(2, kFrame), SLUICE_OK);
    EXPECT_EQ(draw(2, 2), pictures[1]);
    ASSERT_EQ(api().set_simulation(renderer->get(), nullptr, &said), SLUICE_OK);
    auto still = sized<SluiceStart>();
    still.particle_count = block.simulation.particle_count;
    still.position = block.position.data();
    EXPECT_EQ(reset(&still), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(said.message, HasSubstr("there is no simulation"));
}

}  // namespace
}  // namespace sluice::vk::test
