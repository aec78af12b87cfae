// SPDX-License-Identifier: MIT
// A fluid that flows inside the renderer: the same bits as the solver by itself, drawn where it lies, while frames run.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core_live_rig.hpp"
#include "live/seen_depths.hpp"

namespace sluice::vk::test {
namespace {

TEST_F(LiveFluid, IsTheSolversOwnToTheBitForEveryNumberOfFramesInFlight) {
    constexpr std::uint64_t kValues = 6;
    const Block still;
    // What a host would upload of them, drawn.
    ASSERT_NO_FATAL_FAILURE(start(still));
    const std::vector<std::vector<std::byte>> pictures = uploaded(still, kValues);
    EXPECT_NE(pictures.front(), pictures.back()) << "it falls";
    for (std::uint32_t in_flight = 1; in_flight <= SLUICE_MAX_FRAMES_IN_FLIGHT; ++in_flight) {
        const Block block(in_flight);
        ASSERT_NO_FATAL_FAILURE(start(block));
        std::uint64_t asked = 0;
        for (std::uint64_t k = 1; k <= kValues; ++k) {
            for (; asked < std::min(kValues, k + in_flight - 1); ++asked) {
                ASSERT_EQ(simulate(asked + 1, asked == 0 ? 0.0 : kFrame), SLUICE_OK) << said.message;
            }
            EXPECT_EQ(draw(k, k), pictures[k - 1]) << "value " << k << ", " << in_flight << " frames in flight";
            EXPECT_EQ(frameStats(k).upload_bytes, 0U);
        }
        EXPECT_EQ(stats().reached, kValues);
        EXPECT_EQ(stats().failed, 0U);
        EXPECT_GE(stats().steps, 2 * (kValues - 1));
        EXPECT_EQ(frameStats(kValues).validation_messages, 0U) << "synchronisation validation included";
    }
}

TEST_F(LiveFluid, CallsOutOfOrderAreRefusedByName) {
    const Block block;
    ASSERT_NO_FATAL_FAILURE(start(block));
    EXPECT_EQ(simulate(2, 0.0), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(said.message).find("1 was expected"), std::string::npos) << said.message;
    EXPECT_EQ(simulate(1, -1.0), SLUICE_ERROR_INVALID_ARGUMENT);
    SluiceFrame frame = frameOf(1, 2, SLUICE_VIEW_FLUID);
    frame.simulation = 1;
    EXPECT_EQ(renderer->submit(frame), SLUICE_ERROR_INVALID_ARGUMENT) << "nobody has asked for it";
    for (std::uint64_t value = 1; value <= 3; ++value) {
        ASSERT_EQ(simulate(value, 0.0), SLUICE_OK);
    }
    EXPECT_EQ(renderer->submit(frame), SLUICE_ERROR_INVALID_ARGUMENT) << "of two slots, its own is being overwritten";
    EXPECT_NE(std::string(renderer->error().message).find("value 1 cannot be drawn"), std::string::npos);
    draw(1, 2);

    Block bad;
    bad.solid.kind = 9;
    EXPECT_EQ(api().set_simulation(renderer->get(), &bad.simulation, &said), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(simulate(4, 0.0), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(said.message).find("there is no simulation"), std::string::npos) << said.message;
    bad.solid.kind = SLUICE_SOLID_SPHERE;
    bad.simulation.frames_in_flight = 4;
    EXPECT_EQ(api().set_simulation(renderer->get(), &bad.simulation, &said), SLUICE_ERROR_INVALID_ARGUMENT);
    bad.simulation.frames_in_flight = 1;
    bad.position[1] = 7.0F;
    EXPECT_EQ(api().set_simulation(renderer->get(), &bad.simulation, &said), SLUICE_ERROR_INVALID_ARGUMENT);
    auto none = sized<SluiceSimulationStats>();
    EXPECT_EQ(api().simulation_stats(renderer->get(), &none), SLUICE_ERROR_INVALID_ARGUMENT) << "it has ended";
    EXPECT_EQ(api().simulation_wait(renderer->get(), 1, 0), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(simulate(1, 0.0), SLUICE_ERROR_INVALID_ARGUMENT);
}

TEST_F(LiveFluid, CanBeReplacedAgainAndAgainRightAfterAFrame) {
    const Block block;
    ASSERT_NO_FATAL_FAILURE(start(block, false, false));
    for (std::uint64_t k = 1; k <= 30; ++k) {
        ASSERT_EQ(simulate(1, 0.0), SLUICE_OK) << said.message;
        draw(k, 1);
        ASSERT_EQ(api().set_simulation(renderer->get(), &block.simulation, &said), SLUICE_OK) << said.message;
    }
}

TEST_F(LiveFluid, AStepThatCannotBeTakenLeavesTheLastGoodStateInEveryFrameAfterIt) {
    Block block;
    std::vector<float> velocity(block.position.size(), 0.0F);
    velocity[0] = 1e7F;
    block.simulation.velocity = velocity.data();
    ASSERT_NO_FATAL_FAILURE(start(block));
    ASSERT_EQ(simulate(1, 0.0), SLUICE_OK);
    const std::vector<std::byte> good = draw(1, 1);
    for (std::uint64_t k = 2; k <= 3; ++k) {
        ASSERT_EQ(simulate(k, kFrame), SLUICE_OK);
        EXPECT_EQ(draw(k, k), good);
    }
    EXPECT_EQ(stats().failed, 2U);
    EXPECT_EQ(stats().reached, 3U);
    EXPECT_NE(std::string(stats().message).find("no step was stable"), std::string::npos) << stats().message;
    EXPECT_EQ(logged("last good state"), 1U);
    EXPECT_EQ(frameStats(3).validation_messages, 0U);
}

TEST_F(LiveFluid, EndsWhileItRunsAndWhileAFrameWaitsForAPromiseThatIsNeverKept) {
    const Block block(3);
    ASSERT_NO_FATAL_FAILURE(start(block));
    ASSERT_EQ(simulate(1, 0.0), SLUICE_OK);
    SluiceFrame frame = frameOf(1, 2, SLUICE_VIEW_FLUID);
    frame.simulation = 1;
    ASSERT_EQ(renderer->submit(frame), SLUICE_OK) << renderer->error().message;
    for (std::uint64_t value = 2; value <= 40; ++value) {
        ASSERT_EQ(simulate(value, kFrame), SLUICE_OK);
    }
    renderer->destroy();
    EXPECT_EQ(logged("validation:"), 0U);
}

TEST_F(LiveFluid, EndsAfterTheStepUnderWayAndNotAfterTheValue) {
    Block block;
    block.simulation.longest_step = 0.005;
    ASSERT_NO_FATAL_FAILURE(start(block, true));
    const auto steps = [this] {
        const auto events = host->events();
        return std::count_if(events.begin(), events.end(), [](const SeenEvent& seen) {
            return seen.event.track == SLUICE_TRACK_SIMULATION && seen.name == "step";
        });
    };
    ASSERT_EQ(simulate(1, 20.0), SLUICE_OK);  // 4000 steps
    while (steps() == 0) {
        ASSERT_EQ(stats().failed, 0U) << stats().message;
    }
    EXPECT_EQ(api().set_simulation(renderer->get(), nullptr, nullptr), SLUICE_OK);
    EXPECT_LT(steps(), 4000);
    renderer->destroy();
}

TEST_F(LiveFluid, TooLittleTimeForAStepIsOwedToTheNextValue) {
    const Block block;
    ASSERT_NO_FATAL_FAILURE(start(block));
    ASSERT_EQ(simulate(1, 1e-300), SLUICE_OK);
    const std::vector<std::byte> before = draw(1, 1);
    ASSERT_EQ(simulate(2, block.simulation.longest_step / 2048.0), SLUICE_OK);
    EXPECT_EQ(draw(2, 2), before);
    EXPECT_EQ(stats().steps, 0U);
    ASSERT_EQ(simulate(3, block.simulation.longest_step / 2048.0), SLUICE_OK);
    draw(3, 3);
    EXPECT_EQ(stats().steps, 1U);
    EXPECT_DOUBLE_EQ(stats().shortest_step, block.simulation.longest_step / 1024.0);
    ASSERT_EQ(simulate(4, kFrame), SLUICE_OK);
    draw(4, 4);
    EXPECT_EQ(stats().failed, 0U) << stats().message;
}

TEST(SharedBuffers, TheViewOfASecondQueueKnowsBothFamilies) {
    Device device;
    int place = 0;
    device.compute_queue = reinterpret_cast<VkQueue>(&place);
    device.queue_family = 1;
    device.compute_family = 2;
    EXPECT_EQ(device.sharingFamilies(), (std::vector<std::uint32_t>{1, 2}));
    EXPECT_EQ(device.computeView()->sharingFamilies(), device.sharingFamilies());
    device.compute_family = 1;
    EXPECT_TRUE(device.computeView()->sharingFamilies().empty());
}

TEST(SeenDepths, EachValueHasTheDepthOfAFrameThatIsKnownByNumber) {
    const auto made = [] { return std::make_shared<const DepthBuffer>(); };
    SeenDepths depths(2);
    EXPECT_EQ(depths.sourceOf(1), 0U) << "nothing has been seen by then";
    EXPECT_EQ(depths.sourceOf(2), 1U);
    EXPECT_EQ(depths.sourceOf(3), 1U);
    EXPECT_EQ(depths.sourceOf(9), 7U);
    EXPECT_TRUE(depths.known(0));
    EXPECT_FALSE(depths.known(1));
    EXPECT_EQ(depths.at(0).buffer, nullptr);
    const auto first = made();
    depths.drawn(1, {first, 11});
    EXPECT_TRUE(depths.known(1));
    depths.drawn(1, {made(), 12});  // the same value once more, in a later frame
    EXPECT_EQ(depths.at(1).buffer, first);
    EXPECT_EQ(depths.at(1).signal, 11U);
    depths.drawn(2, {});  // a frame that captures nothing
    depths.passed(4);     // values that nobody draws
    EXPECT_EQ(depths.at(4).buffer, first);
    const auto fifth = made();
    depths.drawn(5, {fifth, 15});
    EXPECT_EQ(depths.at(4).buffer, first);
    EXPECT_EQ(depths.at(5).buffer, fifth);
    depths.forget(4);
    EXPECT_EQ(first.use_count(), 2) << "4 still has it";
    depths.forget(7);
    EXPECT_EQ(first.use_count(), 1);
    EXPECT_EQ(depths.at(7).buffer, fifth);
}

TEST(SeenDepths, ADepthThatTheDeviceCannotBindIsRefusedBeforeAnythingIsMade) {
    Device device;  // which could make nothing
    device.properties.limits.maxStorageBufferRange = 1024;
    SeenDepths depths(1);
    const auto made = depths.room(device, 1025);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, SLUICE_ERROR_UNSUPPORTED);
    EXPECT_NE(made.error().message().find("1025 bytes, this device binds at most 1024"), std::string::npos);
}

TEST_F(LiveFluid, WaitsForNoDepthOfAValueThatCanBeDrawnNoMore) {
    Block block;
    block.simulation.depth_scale = 2;
    ASSERT_NO_FATAL_FAILURE(start(block));
    for (std::uint64_t value = 1; value <= 6; ++value) {
        ASSERT_EQ(simulate(value, kFrame), SLUICE_OK) << said.message;
    }
    // Two slots: a frame may still draw values 5 and 6, and 6 collides with what the frame of 5 shows.
    EXPECT_EQ(api().simulation_wait(renderer->get(), 5, kLong), SLUICE_OK);
    EXPECT_EQ(stats().failed, 0U) << stats().message;
    renderer->destroy();
}

TEST_F(LiveFluid, WaitsForTheDepthOfTheFrameThatItCollidesWith) {
    constexpr std::uint64_t kValues = 6;
    for (const std::uint32_t in_flight : {1U, 2U, 3U}) {
        Block block(in_flight);
        block.simulation.depth_scale = 2;
        block.simulation.depth_lag = in_flight == 3 ? 2 : 0;
        ASSERT_NO_FATAL_FAILURE(start(block, true));
        std::uint64_t asked = 0;
        for (std::uint64_t k = 1; k <= kValues; ++k) {
            for (; asked < std::min(kValues, k + in_flight - 1); ++asked) {
                ASSERT_EQ(simulate(asked + 1, asked == 0 ? 0.0 : kFrame), SLUICE_OK) << said.message;
            }
            const bool captures = k != 4;
            draw(k, k, captures ? std::uint32_t{SLUICE_FRAME_CAPTURE_DEPTH} : 0U);
            const SluiceFrameStats of_frame = frameStats(k);
            EXPECT_EQ(std::string(of_frame.passes[0].name) == "capture_depth", captures) << k;
        }
        EXPECT_EQ(frameStats(kValues).validation_messages, 0U);
        EXPECT_EQ(stats().failed, 0U) << stats().message;
        renderer->destroy();
        std::map<std::uint64_t, std::uint64_t> waited;  // by value: the frame
        // Of frames and of the simulation.
        std::array<std::uint64_t, 2> released{};
        std::array<std::uint64_t, 2> acquired{};
        std::uint64_t freed = 0;
        for (const SeenEvent& seen : host->events()) {
            if (seen.name == "depth captured") {
                waited[seen.event.frame] = seen.event.value;
            }
            if (!seen.name.starts_with("CAPTURED_DEPTH ")) {
                continue;
            }
            const std::size_t by = seen.event.track == SLUICE_TRACK_SIMULATION ? 1 : 0;
            released.at(by) += seen.event.kind == SLUICE_TRACE_RELEASE ? 1U : 0U;
            acquired.at(by) += seen.event.kind == SLUICE_TRACE_ACQUIRE ? 1U : 0U;
            if (by == 1 && seen.event.kind == SLUICE_TRACE_RELEASE) {
                EXPECT_EQ(seen.event.value, ++freed);
            }
            EXPECT_LT(seen.name.back(), '5') << "buffers are used again";
        }
        // Frame 4 has captured nothing: who needs it has what frame 3 left.
        const std::map<std::uint64_t, std::uint64_t> lag_of_one{{2, 1}, {3, 2}, {4, 3}, {6, 5}};
        const std::map<std::uint64_t, std::uint64_t> lag_of_two{{2, 1}, {4, 2}, {5, 3}};
        EXPECT_EQ(waited, in_flight == 1 ? lag_of_one : lag_of_two) << in_flight;
        EXPECT_EQ(acquired, (std::array<std::uint64_t, 2>{kValues - 1, waited.size()}));
        EXPECT_EQ(released, (std::array<std::uint64_t, 2>{kValues - 1, waited.size() - 1}));
    }
    Block bad;
    ASSERT_NO_FATAL_FAILURE(start(bad));
    const auto refused = [&](std::uint32_t scale, std::uint32_t lag, float thickness) {
        bad.simulation.depth_scale = scale;
        bad.simulation.depth_lag = lag;
        bad.simulation.depth_thickness = thickness;
        said = sized<SluiceError>();
        return api().set_simulation(renderer->get(), &bad.simulation, &said);
    };
    EXPECT_EQ(refused(9, 0, 0.0F), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(refused(1, 2, 0.0F), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(refused(1, 0, 0.02F), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(said.message).find("0.02 m is outside [0.03 (a radius)"), std::string::npos) << said.message;
    ASSERT_EQ(refused(1, 0, 0.12F), SLUICE_OK);
    ASSERT_EQ(simulate(1, 0.0), SLUICE_OK);
    SluiceFrame stretched = frameOf(1, 2, SLUICE_VIEW_FLUID);
    stretched.simulation = 1;
    stretched.flags = SLUICE_FRAME_CAPTURE_DEPTH;
    stretched.camera.view[0] *= 2.0F;
    EXPECT_EQ(renderer->submit(stretched), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(renderer->error().message).find("frame.camera: expected a view"), std::string::npos);
}

/// What a camera of frameOf sees of a floor, and on its right side of one that is higher; both rise from frame to
/// frame.
std::vector<float> floorSeen(const SluiceCamera& camera, std::uint64_t frame) {
    std::vector<float> metres(64 * 48, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < metres.size(); ++i) {
        const float way = ((static_cast<float>(i / 64) + 0.5F) / 24.0F - 1.0F) / camera.projection[5];
        const float height = (i % 64 < 32 ? -0.33F : -0.31F) + 0.002F * static_cast<float>(frame);
        if (way < 0.0F && i % 37 != 0) {
            metres[i] = height / way;
        }
    }
    return metres;
}

TEST_F(LiveFluid, AmongCapturedDepthsItIsTheSolverAmongTheSameDepthsToTheBit) {
    constexpr std::uint64_t kValues = 6;
    const SluiceCamera camera = frameOf(1, 2).camera;
    DepthView view;
    std::copy_n(&camera.view[0], 16, view.view.begin());
    std::copy_n(&camera.projection[0], 16, view.projection.begin());
    view.near_plane = camera.near_plane;
    without_formats = 1U << SLUICE_FORMAT_D32F;  // so it is metres that cross, and nothing has to be computed twice
    for (const std::uint32_t in_flight : {1U, 3U}) {
        Block block(in_flight);
        block.simulation.depth_scale = 2;
        block.simulation.depth_lag = in_flight == 3 ? 2 : 1;
        const std::uint64_t lag = block.simulation.depth_lag;
        const std::vector<ParticleState> blind =
            alone(block.settings, block.position, block.simulation.longest_step, kValues);
        block.settings.seen = std::make_shared<const DepthField>();
        std::uint64_t reached = 0;
        const auto look = [&](Solver& solver) {
            const std::uint64_t seen = std::max<std::uint64_t>(++reached + 1, lag + 1) - lag;
            const float thickness = kThicknessInRadii * block.settings.radius;
            EXPECT_TRUE(solver.setDepthField(depthField(view, 64, 48, 2, thickness, floorSeen(camera, seen))));
        };
        const std::vector<ParticleState> expected =
            alone(block.settings, block.position, block.simulation.longest_step, kValues, look);
        EXPECT_NE(expected.back().position, blind.back().position) << "nobody has met the floor";

        ASSERT_NO_FATAL_FAILURE(start(block));
        ASSERT_EQ(renderer->get()->info().host_depth_encoding, std::uint32_t{SLUICE_DEPTH_LINEAR});
        std::uint64_t asked = 0;
        for (std::uint64_t k = 1; k <= kValues; ++k) {
            for (; asked < std::min(kValues, k + in_flight - 1); ++asked) {
                ASSERT_EQ(simulate(asked + 1, asked == 0 ? 0.0 : kFrame), SLUICE_OK) << said.message;
            }
            SluiceFrame frame = frameOf(k, 2, SLUICE_VIEW_FLUID);
            frame.simulation = k;
            frame.flags = SLUICE_FRAME_CAPTURE_DEPTH;
            ASSERT_EQ(renderer->submit(frame), SLUICE_OK) << renderer->error().message;
            const std::vector<float> metres = floorSeen(camera, k);
            ASSERT_TRUE(host->fill(SLUICE_IMAGE_HOST_DEPTH, frame.image_set, std::as_bytes(std::span(metres))));
            ASSERT_EQ(api().timeline_signal(renderer->get(), frame.wait_value), SLUICE_OK);
            ASSERT_EQ(api().timeline_wait(renderer->get(), k, kLong), SLUICE_OK);
            ASSERT_EQ(api().timeline_signal(renderer->get(), frame.wait_value + 1), SLUICE_OK);
            EXPECT_EQ(positions(k), expected[k - 1].position) << "value " << k << ", lag " << lag;
        }
        EXPECT_EQ(stats().failed, 0U) << stats().message;
        EXPECT_EQ(frameStats(kValues).validation_messages, 0U);
    }
}

TEST_F(LiveFluid, TellsEachStepAndEachSideOfTheHandOver) {
    const Block block;
    ASSERT_NO_FATAL_FAILURE(start(block, true));
    for (std::uint64_t k = 1; k <= 4; ++k) {
        ASSERT_EQ(simulate(k, k == 1 ? 0.0 : kFrame), SLUICE_OK);
        draw(k, k);
        (void)frameStats(k);
    }
    renderer->destroy();
    std::size_t steps = 0;
    std::array<std::uint64_t, 2> told{};  // the last value signalled, and waited for
    std::uint64_t slot_waits = 0;
    for (const SeenEvent& seen : host->events()) {
        steps += seen.event.track == SLUICE_TRACK_SIMULATION && seen.name == "step" ? 1U : 0U;
        const bool simulation = seen.event.direction == SLUICE_SIMULATION_TO_RENDERER;
        if (seen.event.kind == SLUICE_TRACE_SIGNAL && simulation) {
            EXPECT_EQ(seen.event.track, static_cast<std::uint32_t>(SLUICE_TRACK_SIMULATION));
            EXPECT_EQ(seen.event.value, ++told[0]);
        }
        if (seen.event.kind == SLUICE_TRACE_WAIT && simulation) {
            EXPECT_EQ(seen.event.track, static_cast<std::uint32_t>(SLUICE_TRACK_RENDERER_QUEUE));
            EXPECT_EQ(seen.event.value, ++told[1]);
        }
        slot_waits += seen.event.kind == SLUICE_TRACE_WAIT && seen.event.track == SLUICE_TRACK_SIMULATION ? 1U : 0U;
    }
    EXPECT_GE(steps, 6U) << "two steps a value at least";
    EXPECT_EQ(told, (std::array<std::uint64_t, 2>{4, 4}));
    EXPECT_EQ(slot_waits, 2U) << "values 3 and 4 wait for the frames of values 1 and 2";
}

}  // namespace
}  // namespace sluice::vk::test
