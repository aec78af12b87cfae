// SPDX-License-Identifier: MIT
// What comes, goes, moves and stands in a fluid inside the renderer (ABI 1.2): the solver's own bits, and what is
// refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core_live_rig.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::AllOf;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::Le;

constexpr std::uint64_t kValues = 6;

class LiveSources : public LiveFluid {
  protected:
    SluiceBodies bodies(std::uint64_t value) {
        auto out = sized<SluiceBodies>();
        EXPECT_EQ(api().simulation_bodies(renderer->get(), value, &out), SLUICE_OK);
        return out;
    }
};

/// A jet into the block, and a drain below it: somebody comes and goes in nearly every step.
struct Tap : Block {
    explicit Tap(std::uint32_t frames_in_flight = 1) : Block(frames_in_flight) {
        emitter.shape = SLUICE_OPENING_DISC;
        emitter.centre[1] = 0.7F;
        emitter.centre[2] = -2.0F;
        emitter.direction[1] = -1.0F;
        emitter.width = emitter.height = 0.2F;
        emitter.speed = 3.0F;
        drain.shape = SLUICE_REGION_BOX;
        drain.centre[1] = -0.4F;
        drain.centre[2] = -2.0F;
        drain.half[0] = drain.half[2] = 0.5F;
        drain.half[1] = 0.12F;
        field.kind = SLUICE_FIELD_WIND;
        field.axis[0] = 1.0F;
        field.strength = 3.0F;
        simulation.emitters = &emitter;
        simulation.drains = &drain;
        simulation.fields = &field;
        simulation.emitter_count = simulation.drain_count = simulation.field_count = 1;
        simulation.max_particles = 1000;
        simulation.tension = settings.tension = 0.1F;
        simulation.adhesion = settings.adhesion = 0.05F;
        simulation.vorticity = settings.vorticity = 0.01F;
        simulation.overshoot = settings.overshoot = 0.15F;
        simulation.density_kernel = SLUICE_KERNEL_WENDLAND;
        settings.kernel = DensityKernel::Wendland;
        settings.sources.emitters = {{true, {0, 0.7F, -2.0F}, {0, -1, 0}, 0.2F, 0.2F, 3.0F, 0.0F, 0.0F, 0.0F}};
        settings.sources.drains = {{false, {0, -0.4F, -2.0F}, {0.5F, 0.12F, 0.5F}}};
        settings.sources.fields = {{ForceKind::Wind, {}, {1, 0, 0}, 3.0F, 0.0F}};
    }
    SluiceEmitter emitter{};
    SluiceDrain drain{};
    SluiceForceField field{};
};

TEST_F(LiveSources, WhoComesAndGoesIsTheSolversOwnToTheBitForEveryNumberOfFramesInFlight) {
    std::vector<std::uint32_t> living;
    Tap tap;
    tap.seen = [&](Solver& solver) { living.push_back(solver.count()); };
    ASSERT_NO_FATAL_FAILURE(start(tap));
    const auto pictures = uploaded(tap, kValues);
    ASSERT_NE(living.front(), living.back());
    for (std::uint32_t in_flight = 1; in_flight <= SLUICE_MAX_FRAMES_IN_FLIGHT; ++in_flight) {
        ASSERT_NO_FATAL_FAILURE(expectPictures(Tap(in_flight), pictures));
        EXPECT_EQ(frameStats(kValues).passes[0].elements, living.back()) << "exactly those of its value are drawn";
        EXPECT_EQ(stats().particle_count, living.back());
    }
    // From nothing at all, and with no more than may be.
    Tap empty;
    empty.position.clear();
    empty.simulation.particle_count = 0;
    empty.simulation.max_particles = empty.settings.sources.most_particles = 60;
    ASSERT_NO_FATAL_FAILURE(start(empty));
    living.clear();
    empty.seen = tap.seen;
    const auto from_nothing = uploaded(empty, kValues);
    EXPECT_THAT(*std::max_element(living.begin(), living.end()), AllOf(Gt(30U), Le(60U)));
    ASSERT_NO_FATAL_FAILURE(expectPictures(empty, from_nothing));
}

TEST_F(LiveSources, TheFlowChangesWhileItFlowsAsTheSolversDoes) {
    // From value 3 on the jet is elsewhere, and all else is different, too; from 5 on it is shut.
    const auto flowAt = [](std::uint64_t value, const Tap& tap) {
        auto flow = sized<SluiceFlow>();
        flow.iterations = value == 3 ? 3 : 4;
        flow.gravity[value == 3 ? 0 : 1] = -9.81F;
        flow.viscosity = 0.02F;
        flow.tension = value == 3 ? 1.0F : 0.0F;
        flow.emitter_count = value == 3 ? 1 : 0;
        flow.emitters[0] = tap.emitter;
        flow.emitters[0].centre[0] = 0.2F;
        return flow;
    };
    const auto settingsAt = [&](std::uint64_t value, const Tap& tap) {
        FlowSettings to;
        to.iterations = value == 3 ? 3 : 4;
        to.gravity = value == 3 ? Triple{-9.81F, 0, 0} : Triple{0, -9.81F, 0};
        to.tension = value == 3 ? 1.0F : 0.0F;
        if (value == 3) {
            to.emitters = tap.settings.sources.emitters;
            to.emitters[0].centre[0] = 0.2F;
        }
        return to;
    };
    Tap tap;
    tap.simulation.drain_count = 0;
    tap.settings.sources.drains.clear();
    std::vector<std::uint32_t> living;
    tap.seen = [&](Solver& solver) {
        living.push_back(solver.count());
        if (const std::uint64_t next = living.size() + 1; next == 3 || next == 5) {
            EXPECT_TRUE(solver.setFlow(settingsAt(next, tap)));
        }
    };
    ASSERT_NO_FATAL_FAILURE(start(tap));
    const auto pictures = uploaded(tap, kValues);
    ASSERT_NO_FATAL_FAILURE(start(tap));
    for (std::uint64_t k = 1; k <= kValues; ++k) {
        if (k == 3 || k == 5) {
            const SluiceFlow flow = flowAt(k, tap);
            ASSERT_EQ(api().set_flow(renderer->get(), &flow, &said), SLUICE_OK) << said.message;
        }
        ASSERT_EQ(simulate(k, k == 1 ? 0.0 : kFrame), SLUICE_OK);
        EXPECT_EQ(draw(k, k), pictures[k - 1]) << "value " << k;
    }
    EXPECT_GT(living[2], living[1]);
    EXPECT_EQ(living[5], living[3]) << "the jet is shut";
    EXPECT_EQ(stats().failed, 0U) << stats().message;
    EXPECT_EQ(frameStats(kValues).validation_messages, 0U);
    // What is wrong is refused at once.
    SluiceFlow wrong = flowAt(3, tap);
    wrong.emitter_count = 2;
    EXPECT_EQ(api().set_flow(renderer->get(), &wrong, &said), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(said.message, HasSubstr("expected at most the 1 of set_simulation, found 2"));
    wrong = flowAt(3, tap);
    wrong.emitters[0].centre[1] = 5.0F;
    EXPECT_EQ(api().set_flow(renderer->get(), &wrong, &said), SLUICE_ERROR_INVALID_ARGUMENT);
    wrong = flowAt(3, tap);
    wrong.iterations = 0;
    EXPECT_EQ(api().set_flow(renderer->get(), &wrong, &said), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().set_flow(renderer->get(), nullptr, &said), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(simulate(kValues + 1, kFrame), SLUICE_OK);
}

/// A ball that floats in the block, a crate on a path, and a sphere that the host drives.
struct Movers : Block {
    Movers() {
        body[0].shape = SLUICE_SOLID_SPHERE;
        body[0].centre[1] = 0.4F;
        body[0].centre[2] = -2.0F;
        body[0].density = 0.5F;
        body[0].velocity[1] = -2.0F;
        body[1].shape = SLUICE_SOLID_BOX;
        body[1].motion = SLUICE_BODY_PATH;
        body[1].path_first = 1;
        body[1].path_count = 2;
        body[2].shape = SLUICE_SOLID_SPHERE;
        body[2].motion = SLUICE_BODY_DRIVEN;
        body[2].centre[0] = -0.3F;
        body[2].centre[1] = -0.1F;
        body[2].centre[2] = -2.0F;
        for (SluiceBody& each : body) {
            std::fill_n(&each.half[0], 3, 0.08F);
        }
        path[1] = {0.0F, {0.4F, -0.3F, -2.0F}, 0.0F, {}};
        path[2] = {0.1F, {0.2F, -0.3F, -2.0F}, 45.0F, {}};
        simulation.bodies = body.data();
        simulation.body_count = 3;
        simulation.path_points = path.data();
        simulation.path_point_count = 3;
        Body ball{SolidKind::Sphere, {0, 0.4F, -2.0F}, {0.08F, 0.08F, 0.08F}, 0.0F, 0.5F, {0, -2.0F, 0}};
        Body crate{SolidKind::Box, {}, {0.08F, 0.08F, 0.08F}};
        crate.path = {{0.0F, {0.4F, -0.3F, -2.0F}, 0.0F}, {0.1F, {0.2F, -0.3F, -2.0F}, 45.0F}};
        Body driven{SolidKind::Sphere, {-0.3F, -0.1F, -2.0F}, {0.08F, 0.08F, 0.08F}};
        driven.driven = true;
        settings.bodies = {ball, crate, driven};
    }
    std::array<SluiceBody, 3> body{};
    std::array<SluicePathPoint, 3> path{};
};

TEST_F(LiveSources, BodiesAreWhereTheSolverHasThemAndADrivenOneIsWhereItWasSent) {
    const std::array<float, 4> quarter{0.0F, std::sqrt(0.5F), 0.0F, std::sqrt(0.5F)};
    const auto sent = [](std::uint64_t k) { return -0.3F + 0.05F * static_cast<float>(k - 1); };
    std::vector<std::vector<BodyState>> states;
    Movers movers;
    movers.seen = [&](Solver& solver) {
        states.emplace_back(solver.bodies().begin(), solver.bodies().end());
        solver.drive(2, {double{sent(states.size() + 1)}, double{-0.1F}, -2.0},
                     {0.0, double{quarter[1]}, 0.0, double{quarter[3]}}, kFrame);
    };
    ASSERT_NO_FATAL_FAILURE(start(movers));
    const auto pictures = uploaded(movers, kValues);
    ASSERT_NO_FATAL_FAILURE(start(movers));
    EXPECT_EQ(bodies(0).value, 0U);
    EXPECT_EQ(bodies(0).bodies[1].centre[0], 0.4F) << "the start";
    EXPECT_EQ(api().simulation_bodies(renderer->get(), 1, &scratch), SLUICE_NOT_READY);
    double pushed = 0.0;
    for (std::uint64_t k = 1; k <= kValues; ++k) {
        if (k > 1) {
            auto target = sized<SluiceBodyTarget>();
            target.centre[0] = sent(k);
            target.centre[1] = -0.1F;
            target.centre[2] = -2.0F;
            std::copy(quarter.begin(), quarter.end(), &target.turn[0]);
            ASSERT_EQ(api().set_body(renderer->get(), 2, &target, &said), SLUICE_OK) << said.message;
        }
        ASSERT_EQ(simulate(k, k == 1 ? 0.0 : kFrame), SLUICE_OK);
        EXPECT_EQ(draw(k, k), pictures[k - 1]);
        const SluiceBodies found = bodies(k);
        ASSERT_EQ(found.count, 3U);
        EXPECT_EQ(found.value, k);
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                EXPECT_EQ(found.bodies[i].centre[axis], static_cast<float>(states[k - 1][i].centre[axis]));
            }
        }
        EXPECT_EQ(found.bodies[2].centre[0], sent(k));
        EXPECT_NEAR(found.bodies[2].turn[1], k == 1 ? 0.0F : quarter[1], 1e-6F);
        EXPECT_NEAR(double{found.bodies[2].velocity[0]}, k == 1 ? 0.0 : 0.05 / kFrame, 1e-3);
        pushed += double{found.bodies[0].force[1]};
    }
    EXPECT_GT(pushed, 0.0) << "the water holds the ball up";
    EXPECT_EQ(bodies(0).value, kValues);
    EXPECT_EQ(stats().failed, 0U) << stats().message;
    EXPECT_EQ(api().simulation_bodies(renderer->get(), 1, &scratch), SLUICE_ERROR_INVALID_ARGUMENT) << "kept no more";
    EXPECT_EQ(api().simulation_bodies(renderer->get(), 1, nullptr), SLUICE_ERROR_INVALID_ARGUMENT);
    auto target = sized<SluiceBodyTarget>();
    EXPECT_EQ(api().set_body(renderer->get(), 2, &target, &said), SLUICE_ERROR_INVALID_ARGUMENT)
        << "a turn of length 0";
    target.turn[3] = 1.0F;
    EXPECT_EQ(api().set_body(renderer->get(), 0, &target, &said), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(said.message, HasSubstr("body 0 of 3 is none that is driven"));
    target.centre[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(api().set_body(renderer->get(), 2, &target, &said), SLUICE_ERROR_INVALID_ARGUMENT);
}

/// Two boxes, of 8 corners and 12 triangles each, under the block.
struct Meshes : Block {
    Meshes() {
        for (const float x : {-0.2F, 0.2F}) {
            for (unsigned corner = 0; corner < 8; ++corner) {
                corners.push_back(x + ((corner & 1U) != 0 ? 0.15F : -0.15F));
                corners.push_back((corner & 2U) != 0 ? -0.35F : -0.45F);
                corners.push_back(-2.0F + ((corner & 4U) != 0 ? 0.2F : -0.2F));
            }
            indices.insert(indices.end(), {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                           2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5});
        }
        std::vector<Mesh> all(2);
        for (std::size_t i = 0; i < 16; ++i) {
            all[i / 8].corners.push_back(
                {double{corners[3 * i]}, double{corners[3 * i + 1]}, double{corners[3 * i + 2]}});
        }
        for (std::size_t i = 0; i < 24; ++i) {
            all[i / 12].triangles.push_back({indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]});
        }
        settings.solids.clear();
        simulation.solid_count = 0;
        settings.meshes = std::make_shared<const DistanceGrid>(
            distanceGrid(all, settings.radius, settings.low, settings.high).value());
        mesh.fill({8, 12, {}});
        simulation.meshes = mesh.data();
        simulation.mesh_count = 2;
        simulation.mesh_corners = corners.data();
        simulation.mesh_indices = indices.data();
        simulation.mesh_corner_count = 16;
        simulation.mesh_triangle_count = 24;
    }
    std::vector<float> corners;
    std::vector<std::uint32_t> indices;
    std::array<SluiceMesh, 2> mesh{};
};

TEST_F(LiveSources, MeshesAreTheSolversOwnToTheBit) {
    const Meshes meshes;
    ASSERT_NO_FATAL_FAILURE(start(meshes));
    const auto pictures = uploaded(meshes, kValues);
    ASSERT_NO_FATAL_FAILURE(expectPictures(meshes, pictures));
}

TEST_F(LiveSources, AHostOfAbi11GetsTheFluidOf11) {
    Block block;
    ASSERT_NO_FATAL_FAILURE(start(block));
    const auto pictures = uploaded(block, 4);
    block.simulation.struct_size = 112;
    block.simulation.emitter_count = 7;  // what lies behind the struct of 1.1 is none of the renderer's
    ASSERT_NO_FATAL_FAILURE(expectPictures(block, pictures));
}

TEST_F(LiveSources, WhatIsOutOfItsRangeIsRefusedByName) {
    ASSERT_NO_FATAL_FAILURE(start(Block()));
    const auto refused = [this](const Block& block) {
        said = sized<SluiceError>();
        EXPECT_EQ(api().set_simulation(renderer->get(), &block.simulation, &said), SLUICE_ERROR_INVALID_ARGUMENT);
        return std::string(&said.message[0]);
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto tap = [&](auto change) {
        Tap wrong;
        change(wrong);
        return refused(wrong);
    };
    EXPECT_THAT(tap([](Tap& t) { t.simulation.emitter_count = 17; }), HasSubstr("emitters: expected at most 16"));
    EXPECT_THAT(tap([](Tap& t) { t.simulation.drains = nullptr; }), HasSubstr("drains"));
    EXPECT_THAT(tap([](Tap& t) { t.simulation.field_count = UINT32_MAX; }), HasSubstr("fields: expected at most 16"));
    EXPECT_THAT(tap([](Tap& t) { t.emitter.shape = 2; }), HasSubstr("emitters: number 0 has the shape 2"));
    EXPECT_THAT(tap([](Tap& t) { t.drain.shape = 2; }), HasSubstr("drains: number 0 has the shape 2"));
    EXPECT_THAT(tap([](Tap& t) { t.field.kind = 3; }), HasSubstr("fields: number 0 has the kind 3"));
    EXPECT_THAT(tap([&](Tap& t) { t.emitter.speed = nan; }), HasSubstr("emitter 0"));
    EXPECT_THAT(tap([&](Tap& t) { t.drain.half[1] = nan; }), HasSubstr("drain 0"));
    EXPECT_THAT(tap([&](Tap& t) { t.field.strength = nan; }), HasSubstr("field 0"));
    EXPECT_THAT(tap([&](Tap& t) { t.simulation.tension = nan; }), HasSubstr("tension"));
    EXPECT_THAT(tap([&](Tap& t) { t.simulation.overshoot = nan; }), HasSubstr("overshoot"));
    EXPECT_THAT(tap([](Tap& t) { t.simulation.density_kernel = SLUICE_KERNEL_COUNT; }),
                HasSubstr("density_kernel: 4 is no SluiceDensityKernel"));
    EXPECT_THAT(tap([](Tap& t) { t.simulation.max_particles = 0; }),
                HasSubstr("max_particles: 0 is outside 288..4000000"));
    EXPECT_THAT(tap([](Tap& t) { t.simulation.max_particles = 4'000'001; }), HasSubstr("max_particles"));
    EXPECT_THAT(tap([](Tap& t) { t.simulation.particle_count = t.simulation.emitter_count = 0; }),
                HasSubstr("expected particles or an emitter"));

    const auto movers = [&](auto change) {
        Movers wrong;
        change(wrong);
        return refused(wrong);
    };
    EXPECT_THAT(movers([](Movers& m) { m.simulation.body_count = 17; }), HasSubstr("bodies: expected at most 16"));
    EXPECT_THAT(movers([](Movers& m) { m.body[0].shape = SLUICE_SOLID_PLANE; }), HasSubstr("number 0 has the shape 0"));
    EXPECT_THAT(movers([](Movers& m) { m.body[2].motion = 3; }), HasSubstr("number 2 has the motion 3"));
    EXPECT_THAT(movers([](Movers& m) { m.body[1].path_count = 3; }), HasSubstr("end at 4, and there are 3"));
    EXPECT_THAT(movers([](Movers& m) { m.body[1].path_first = UINT32_MAX; }), HasSubstr("and there are 3"));
    EXPECT_THAT(movers([](Movers& m) { m.body[2].path_count = 1; }), HasSubstr("has the motion 2 and 1 path points"));
    EXPECT_THAT(movers([&](Movers& m) { m.path[2].centre[0] = nan; }), HasSubstr("body 1"));
    EXPECT_THAT(movers([&](Movers& m) { m.body[0].spin[0] = nan; }), HasSubstr("body 0"));

    const auto meshes = [&](auto change) {
        Meshes wrong;
        change(wrong);
        return refused(wrong);
    };
    EXPECT_THAT(meshes([](Meshes& m) { m.simulation.mesh_count = 1U << 11U; }),
                HasSubstr("meshes: expected at most 1024"));
    EXPECT_THAT(meshes([](Meshes& m) { m.simulation.mesh_corner_count = 15; }),
                HasSubstr("number 1: its corners end at 16"));
    EXPECT_THAT(meshes([](Meshes& m) { m.simulation.mesh_triangle_count = 23; }), HasSubstr("its triangles end at 24"));
    EXPECT_THAT(meshes([](Meshes& m) { m.indices[5] = 8; }), HasSubstr("corner 9 of 8"));
    EXPECT_THAT(meshes([&](Meshes& m) { m.corners[1] = nan; }), HasSubstr("number 0: "));
    EXPECT_THAT(meshes([&](Meshes& m) { m.simulation.radius = nan; }), HasSubstr("radius"));
    EXPECT_THAT(meshes([](Meshes& m) { m.simulation.mesh_indices = nullptr; }), HasSubstr("mesh_indices"));
}

}  // namespace
}  // namespace sluice::vk::test
