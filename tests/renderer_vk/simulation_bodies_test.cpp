// SPDX-License-Identifier: MIT
// Bodies in the fluid: what they do to it, what it does to them, and what they do to each other.
#include <gmock/gmock.h>

#include <shaders/simulation_push_sums_comp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "device/commands.hpp"
#include "device/one_shot.hpp"
#include "device/structs.hpp"
#include "memory/buffer.hpp"
#include "passes/pipeline.hpp"
#include "reference/simulation_reference.hpp"
#include "simulation/parameters.hpp"
#include "simulation_rig.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

class SimulationBodies : public SimulationTest {};

std::vector<Vec> wideAll(const std::vector<float>& triples) {
    std::vector<Vec> vectors(triples.size() / 3);
    for (std::size_t i = 0; i < triples.size(); ++i) {
        vectors[i / 3][i % 3] = double{triples[i]};
    }
    return vectors;
}

Body body(SolidKind shape, const Triple& centre, const Triple& half, float density) {
    Body made;
    made.shape = shape;
    made.centre = centre;
    made.half = half;
    made.density = density;
    return made;
}

double massOf(const Body& body) {
    return double{body.density} * bodyVolume(body);
}

std::vector<float> outsideBodies(const SimulationSettings& settings, const std::vector<float>& positions) {
    std::vector<float> kept;
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        const Triple x{positions[i], positions[i + 1], positions[i + 2]};
        if (std::all_of(settings.bodies.begin(), settings.bodies.end(), [&](const Body& one) {
                return distanceTo(solidOf(one, startOf(one)), x) > 0.9 * double{settings.radius};
            })) {
            kept.insert(kept.end(), x.begin(), x.end());
        }
    }
    return kept;
}

TEST_F(SimulationBodies, OneStepMatchesTheDoublePrecisionReferenceWithItsImpulses) {
    SimulationSettings settings;
    settings.low = {0, 0, 0};
    settings.high = {0.9F, 1, 0.8F};
    settings.bodies = {body(SolidKind::Box, {0.2F, 0.3F, 0.2F}, {0.1F, 0.06F, 0.1F}, 0.5F),
                       body(SolidKind::Sphere, {0.1F, 0.08F, 0.1F}, {0.06F, 0.06F, 0.06F}, 2.0F),
                       body(SolidKind::Capsule, {0.36F, 0.2F, 0.1F}, {0.04F, 0.1F, 0.04F}, 1.0F)};
    settings.bodies[0].turn_degrees = 30.0F;
    settings.bodies[0].velocity = {0, -1, 0.2F};
    settings.bodies[0].spin = {1, 2, -1};
    settings.bodies[1].velocity = {0.5F, 1, 0};
    const std::vector<float> positions =
        outsideBodies(settings, lattice({0.02F, 0.02F, 0.02F}, 10, 9, 9, 0.037F, 0.006F, 7));
    Dice dice(3);
    std::vector<float> velocities(positions.size());
    std::generate(velocities.begin(), velocities.end(), [&] { return dice.between(-1.0F, 1.0F); });
    constexpr double kDt = 1.0 / 256.0;
    const auto solver = make(settings, positions, velocities);
    std::vector<BodyState> states(solver->bodies().begin(), solver->bodies().end());
    states = movedBodies(settings.bodies, states, {}, settings.gravity, 0.0, kDt);
    std::vector<ReferenceBody> bodies;
    for (std::size_t i = 0; i < states.size(); ++i) {
        bodies.push_back(
            {solidOf(settings.bodies[i], states[i]), states[i].centre, states[i].velocity, states[i].spin});
    }
    ASSERT_TRUE(solver->step(kDt).ok());
    const ReferenceState expected = referenceStep(settings, {wideAll(positions), wideAll(velocities), {}}, kDt, bodies);
    const std::vector<Vec> x = wideAll(solver->read().value().position);
    double farthest = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        farthest = std::max(farthest, length(minus(x[i], expected.position[i])));
    }
    EXPECT_LT(farthest, 5e-5 * double{settings.radius});
    const double mass = std::pow(2.0 * double{settings.radius}, 3) * kRestDensity / kDt / kDt;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const BodyState& state = solver->bodies()[i];
        const double force = mass * length(bodies[i].shift);
        const double torque = mass * length(bodies[i].moment);
        EXPECT_GT(force, 1.0) << "N; the case is worth something: " << i;
        EXPECT_LT(length(plus(state.force, times(mass, bodies[i].shift))), 1e-3 * force) << i;
        EXPECT_LT(length(plus(state.torque, times(mass, bodies[i].moment))), 1e-3 * torque + 1e-3 * force * 0.1) << i;
    }
}

TEST_F(SimulationBodies, MomentumOfFluidAndBodyTogetherIsKept) {
    SimulationSettings settings;
    settings.gravity = {0, 0, 0};
    settings.low = {-4, -4, -4};
    settings.high = {4, 4, 4};
    settings.bodies = {body(SolidKind::Box, {0.35F, 0, 0}, {0.1F, 0.15F, 0.1F}, 0.6F)};
    settings.bodies[0].velocity = {-1, 0, 0.3F};
    const std::vector<float> positions = lattice({-0.2F, -0.2F, -0.2F}, 10, 10, 10, 0.04F, 0.002F, 2);
    std::vector<float> velocities(positions.size(), 0.0F);
    for (std::size_t i = 0; i < velocities.size(); i += 3) {
        velocities[i] = 1.5F;
    }
    const auto solver = make(settings, positions, velocities);
    const double particle = std::pow(2.0 * double{settings.radius}, 3);
    const auto momentum = [&] {
        Vec sum = times(massOf(settings.bodies[0]), solver->bodies()[0].velocity);
        for (const Vec& v : wideAll(solver->read().value().velocity)) {
            sum = plus(sum, times(particle, v));
        }
        return sum;
    };
    const Vec before = momentum();
    const double body_before = solver->bodies()[0].velocity[0];
    for (int i = 0; i < 40; ++i) {
        ASSERT_TRUE(solver->step(0.004).ok());
    }
    const Vec after = momentum();
    EXPECT_GT(solver->bodies()[0].velocity[0], body_before + 1.0) << "it was hit";
    // A position's rounding over dt is 3e-5 m/s; a thousandth of what crossed over is far above what those add up to.
    const double crossed = massOf(settings.bodies[0]) * (solver->bodies()[0].velocity[0] - body_before);
    EXPECT_LT(length(minus(after, before)), 1e-3 * crossed);
}

/// Half a metre of water in a box of 0.48 m; gives the mean height of the body, over the level, and its speed at the
/// end.
struct Floated {
    double depth;  ///< of the water's level over the body's lower side, in its heights
    double speed;
};
Floated floated(const SimulationSettings& settings, Solver& solver, std::size_t particles) {
    const auto settle = solver.advance(1.5, 1.0 / 100.0);
    EXPECT_TRUE(settle.ok()) << settle.error().message();
    double depth = 0.0;
    const double area = 0.48 * 0.48;
    const double volume = static_cast<double>(particles) * std::pow(2.0 * double{settings.radius}, 3);
    const Body& crate = settings.bodies[0];
    const double base = 4.0 * double{crate.half[0]} * double{crate.half[2]};
    for (int i = 0; i < 10; ++i) {
        EXPECT_TRUE(solver.advance(0.05, 1.0 / 100.0).ok());
        // level area = volume + base (level - bottom)
        const double bottom = solver.bodies()[0].centre[1] - double{crate.half[1]};
        const double level = (volume - base * bottom) / (area - base);
        depth += (level - bottom) / (2.0 * double{crate.half[1]}) / 10.0;
    }
    return {depth, length(solver.bodies()[0].velocity)};
}

TEST_F(SimulationBodies, ACrateOfHalfTheDensityFloatsHalfUnderWaterAndAHeavyBallSinks) {
    SimulationSettings settings;
    settings.low = {0, 0, 0};
    settings.high = {0.48F, 1.0F, 0.48F};
    settings.bodies = {body(SolidKind::Box, {0.24F, 0.5F, 0.24F}, {0.1F, 0.1F, 0.1F}, 0.5F)};
    const std::vector<float> positions = lattice({0, 0, 0}, 12, 9, 12, 0.04F, 0.0F, 1);
    const Floated crate = floated(settings, *make(settings, positions), positions.size() / 3);
    RecordProperty("depth", std::to_string(crate.depth));
    EXPECT_NEAR(crate.depth, 0.5, 0.12);
    EXPECT_LT(crate.speed, 0.2);

    settings.bodies = {body(SolidKind::Sphere, {0.24F, 0.5F, 0.24F}, {0.08F, 0.08F, 0.08F}, 4.0F)};
    const auto sinking = make(settings, positions);
    ASSERT_TRUE(sinking->advance(1.2, 1.0 / 100.0).ok());
    EXPECT_NEAR(sinking->bodies()[0].centre[1], 0.08, 0.01) << "on the floor";
    EXPECT_LT(length(sinking->bodies()[0].velocity), 0.2);
}

TEST_F(SimulationBodies, ABodyOnAPathPushesTheWaterAndTheSameRunGivesTheSameBits) {
    SimulationSettings settings;
    settings.low = {0, 0, 0};
    settings.high = {1, 0.6F, 0.4F};
    settings.bodies = {body(SolidKind::Box, {}, {0.04F, 0.3F, 0.2F}, 1.0F),
                       body(SolidKind::Sphere, {0.6F, 0.4F, 0.2F}, {0.06F, 0.06F, 0.06F}, 0.3F)};
    settings.bodies[0].path = {{0.0F, {0.05F, 0.3F, 0.2F}, 0.0F}, {0.5F, {0.35F, 0.3F, 0.2F}, 0.0F}};
    const std::vector<float> positions = lattice({0.1F, 0, 0}, 22, 6, 10, 0.04F, 0.0F, 1);
    const auto run = [&] {
        const auto solver = make(settings, positions);
        EXPECT_TRUE(solver->advance(0.6, 1.0 / 60.0).ok());
        EXPECT_NEAR(solver->bodies()[0].centre[0], 0.35, 1e-6);
        EXPECT_NEAR(length(solver->bodies()[0].velocity), 0.0, 1e-9) << "a path ends at rest";
        EXPECT_LT(solver->bodies()[0].force[0], 0.0) << "the water presses back";
        return std::pair{solver->read().value(), solver->bodies()[1]};
    };
    const auto first = run();
    const auto second = run();
    EXPECT_EQ(first.first.position, second.first.position);
    EXPECT_EQ(first.second.centre, second.second.centre);
    for (std::size_t i = 0; i < first.first.position.size(); i += 3) {
        ASSERT_GT(first.first.position[i], 0.39F + 0.98F * settings.radius) << "nobody is left behind the wall";
    }
}

TEST_F(SimulationBodies, ImpulsesOfMoreThanAMillionPushesDoNotWrapAround) {
    constexpr std::uint32_t kGroups = 16384 + 1;  // of 64, each of which fills 12 bits of the 32
    const std::array<VkDescriptorType, 3> types{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                                VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    const auto pipeline = createCompute(device(), {"push_sums", simulation_push_sums_comp, types, 0, {}});
    ASSERT_TRUE(pipeline.ok());
    const auto sums = Buffer::create(
        device(), {sizeof(BodyPush), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::Readback, "push sums"});
    ASSERT_TRUE(sums.ok());
    std::memset(sums.value().mapped().data(), 0, sizeof(BodyPush));
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    const VkDescriptorPoolSize uniforms{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2};
    const std::array<VkDescriptorPoolSize, 2> sizes{size, uniforms};
    auto pool_info = vkStruct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool_info.maxSets = 1;
    pool_info.poolSizeCount = 2;
    pool_info.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    ASSERT_EQ(device().fn.vkCreateDescriptorPool(device().handle, &pool_info, nullptr, &pool), VK_SUCCESS);
    auto allocate = vkStruct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &pipeline.value().set_layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    ASSERT_EQ(device().fn.vkAllocateDescriptorSets(device().handle, &allocate, &set), VK_SUCCESS);
    const VkDescriptorBufferInfo whole{sums.value().buffer(), 0, VK_WHOLE_SIZE};
    auto write = vkStruct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set;
    write.dstBinding = 2;  // it reads neither parameters nor bodies
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &whole;
    device().fn.vkUpdateDescriptorSets(device().handle, 1, &write, 0, nullptr);
    const Status ran = runOnce(device(), [&](VkCommandBuffer commands) {
        const Pipeline& p = pipeline.value();
        device().fn.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, p.handle);
        device().fn.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, p.layout, 0, 1, &set, 0, nullptr);
        device().fn.vkCmdDispatch(commands, kGroups, 1, 1);
        memoryBarrier(device(), commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    });
    device().fn.vkDestroyDescriptorPool(device().handle, pool, nullptr);
    ASSERT_TRUE(ran.ok());
    BodyPush push{};
    std::memcpy(&push, sums.value().mapped().data(), sizeof push);
    const auto sum = [&push](std::size_t i) {
        return static_cast<std::int64_t>(static_cast<std::int32_t>(push.sums.at(i)[1])) * 4096 + push.sums.at(i)[0];
    };
    EXPECT_EQ(sum(0), std::int64_t{kGroups} * 64 * 4095);
    EXPECT_EQ(sum(1), -std::int64_t{kGroups} * 64);
}

TEST(RigidBodies, KeepTheirSpinAndRestOnTheFloor) {
    const std::vector<Body> bodies{body(SolidKind::Box, {0, 1, 0}, {0.1F, 0.2F, 0.3F}, 0.5F)};
    std::vector<BodyState> states{startOf(bodies[0])};
    states[0].spin = {0.1, 3.0, 0.0};  // about the middle axis: it tumbles
    const auto momentum = [&] {
        Vector own = turnedBack(states[0].turn, states[0].spin);
        for (std::size_t i = 0; i < 3; ++i) {
            own.at(i) *= inertiaOverMass(bodies[0]).at(i);
        }
        return turned(states[0].turn, own);
    };
    const Vector before = momentum();
    for (int i = 0; i < 500; ++i) {
        states = movedBodies(bodies, states, {}, {0, 0, 0}, 0.0, 0.01);
    }
    EXPECT_LT(length(minus(momentum(), before)), 1e-9);

    const std::vector<Solid> floor{planeSolid({0, 1, 0}, {0, 0, 0})};
    for (int i = 0; i < 600; ++i) {
        states = movedBodies(bodies, states, floor, {0, -9.81F, 0}, 0.0, 0.01);
    }
    EXPECT_LT(length(states[0].velocity), 0.3) << "it rocks a little, a step of gravity is 0.1 m/s";
    EXPECT_GT(states[0].centre[1], 0.095);
    EXPECT_LT(states[0].centre[1], 0.31);
}

TEST(RigidBodies, OnAPathAreAsFastAsTheyWillEverBe) {
    std::vector<Body> bodies{body(SolidKind::Box, {}, {0.3F, 0.1F, 0.4F}, 1.0F)};
    bodies[0].path = {{0, {0, 0, 0}, 0}, {1, {1, 0, 0}, 0}, {1.5F, {3, 0, 0}, 180.0F}};
    const std::vector<BodyState> states{startOf(bodies[0])};
    EXPECT_NEAR(fastestPoint(bodies, states), (2.0 + 3.14159265 * std::sqrt(0.26)) / 0.5, 1e-5);
}

TEST(RigidBodies, MeetEachOtherWithoutGainOfMomentum) {
    std::vector<Body> bodies{body(SolidKind::Sphere, {0, 0, 0}, {0.1F, 0.1F, 0.1F}, 1.0F),
                             body(SolidKind::Box, {0.5F, 0.02F, 0}, {0.1F, 0.1F, 0.1F}, 2.0F)};
    bodies[0].velocity = {2, 0, 0};
    std::vector<BodyState> states{startOf(bodies[0]), startOf(bodies[1])};
    for (int i = 0; i < 50; ++i) {
        states = movedBodies(bodies, states, {}, {0, 0, 0}, 0.0, 0.01);
    }
    const double sum = massOf(bodies[0]) * states[0].velocity[0] + massOf(bodies[1]) * states[1].velocity[0];
    EXPECT_NEAR(sum, 2.0 * massOf(bodies[0]), 1e-12);
    EXPECT_GT(states[1].velocity[0], 0.2);
    EXPECT_LT(states[0].velocity[0], states[1].velocity[0]);
}

TEST(BodiesCheck, NamesWhatIsWrong) {
    const auto message = [](const auto& change) {
        SimulationSettings settings;
        settings.bodies = {body(SolidKind::Capsule, {0, 1, 0}, {0.1F, 0.2F, 0.1F}, 1.0F)};
        change(settings.bodies[0]);
        const Status status = checkSettings(settings);
        return status.ok() ? std::string() : status.error().message();
    };
    EXPECT_EQ(message([](Body&) {}), "");
    EXPECT_THAT(message([](Body& b) { b.half[1] = 0.05F; }), HasSubstr("the radius of a capsule, its half length"));
    EXPECT_THAT(message([](Body& b) { b.shape = SolidKind::Sphere; }),
                HasSubstr("the radius of a sphere, three times"));
    EXPECT_THAT(message([](Body& b) { b.density = 0; }), HasSubstr("body 0: expected finite numbers and a density"));
    EXPECT_THAT(message([](Body& b) { b.centre[1] = 9; }), HasSubstr("a centre in the domain"));
    EXPECT_THAT(message([](Body& b) { b.path = {{1, {}, 0}, {1, {}, 0}}; }), HasSubstr("times that ascend"));
}

}  // namespace
}  // namespace sluice::vk::test
