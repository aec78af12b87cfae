// SPDX-License-Identifier: MIT
// A renderer that has become useless: the host's frames go on, and another renderer takes its place.
#include <epoxy/gl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "gl_test.hpp"
#include "recovery_rig.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/capability_words.hpp"
#include "sluice/host_gl/recovery.hpp"
#include "sluice/ledger/hand_off_feed.hpp"
#include "sluice/ledger/log.hpp"

namespace sluice::host::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Step = Recovery::Step;

TEST(RecoveryPolicy, TriesAfterOneTwoFourFramesAndThenGivesUp) {
    Recovery recovery({.attempts = 3, .strikes = 2, .settled_frames = 4});
    EXPECT_EQ(recovery.nextFrame(), Step::None);
    recovery.fault();
    std::vector<std::uint64_t> tried_at;
    for (std::uint64_t frame = 1; frame <= 20; ++frame) {
        if (recovery.nextFrame() == Step::Try) {
            tried_at.push_back(frame);
            recovery.tried(false);
        }
    }
    EXPECT_THAT(tried_at, ElementsAre(1, 3, 7));
    EXPECT_TRUE(recovery.givenUp());
    EXPECT_EQ(recovery.nextFrame(), Step::GivenUp);
    recovery.allowTriesAgain();
    EXPECT_EQ(recovery.nextFrame(), Step::Try);
    recovery.tried(false);
    EXPECT_TRUE(recovery.down());
}

TEST(RecoveryPolicy, CountsTriesFromTheBeginningOnlyWhenTheRendererHasSettled) {
    Recovery recovery({.attempts = 3, .strikes = 2, .settled_frames = 4});
    for (std::uint32_t round = 0; round < 3; ++round) {
        recovery.fault();
        recovery.fault();
        std::uint32_t frames = 1;
        while (recovery.nextFrame() == Step::Wait) {
            ++frames;
        }
        EXPECT_EQ(frames, 1U << round);
        recovery.tried(true);
        recovery.frameWithFluid();
    }
    EXPECT_EQ(recovery.tries(), 3U);
    for (int i = 0; i < 4; ++i) {
        recovery.frameWithFluid();
    }
    EXPECT_EQ(recovery.tries(), 0U);
    recovery.fault();
    EXPECT_EQ(recovery.nextFrame(), Step::Try);
}

TEST_F(RecoveryTest, ALostDeviceCostsItsFrameAndTheNextHasFluidAgain) {
    for (const SluiceTimelineKind timeline : {SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH}) {
        resetShim();
        drawn_ = 0;
        ASSERT_NO_FATAL_FAILURE(begin(recovering(timeline)));
        control_->lose_submit = 3;
        EXPECT_EQ(run(2), "ff");
        EXPECT_EQ(run(1), "-");
        control_->lose_submit = 0;
        EXPECT_EQ(run(4), "ffff");
        EXPECT_EQ(host_->renderers(), 2U);
        EXPECT_EQ(control_->destroys, 1U);
        EXPECT_EQ(host_->frame(), 7U) << "numbers go on";
        EXPECT_EQ(host_->stats(7).value().frame, 7U);
        EXPECT_EQ(host_->stats(2).error().code, SLUICE_ERROR_DEVICE_LOST);
        EXPECT_THAT(complaints_, ElementsAre(AllOf(HasSubstr("useless from frame 3 on, created again within 1 frame"),
                                                   HasSubstr("the shim has lost"))))
            << "what comes as it was announced is no warning";
        complaints_.clear();
        host_.reset();
    }
}

TEST_F(RecoveryTest, ARendererThatKeepsFailingIsGivenUpAfterItsTriesAndSaidOnceEach) {
    FluidHostConfig wanted = recovering(SLUICE_TIMELINE_BRIDGED);
    wanted.recovery.attempts = 2;
    ASSERT_NO_FATAL_FAILURE(begin(wanted));
    EXPECT_EQ(run(1), "f");
    control_->lose_submit = 2;
    control_->refuses = 1U << SLUICE_TIMELINE_BRIDGED;
    const int descriptors = openDescriptors();
    EXPECT_EQ(run(12), "------------");
    EXPECT_EQ(control_->attempt_count, 3U);
    EXPECT_EQ(control_->submits, 2U);
    EXPECT_TRUE(descriptorsReturnTo(descriptors)) << openDescriptors() << " instead of " << descriptors;
    EXPECT_THAT(
        complaints_,
        ElementsAre(HasSubstr("created again within 1 frame"), HasSubstr("try 1 of 2 failed, the next one in 2"),
                    AllOf(HasSubstr("try 2 of 2 failed, given up"), HasSubstr("the shim refuses"))));
    EXPECT_THAT(failures_.back(), HasSubstr("there is no renderer: renderer create: the shim refuses this timeline"));
    // A resize is a fresh start.
    resetShim();
    EXPECT_TRUE(host_->resize(kEchoWidth, kEchoHeight));
    EXPECT_EQ(run(2), "ff");
    complaints_.clear();
}

/// The first seven triples of `positions`, which must outlive it.
SluiceParticles sevenAt(const std::vector<float>& positions) {
    auto particles = sized<SluiceParticles>();
    particles.count = 7;
    particles.radius = 0.5F;
    particles.position = positions.data();
    return particles;
}

TEST_F(RecoveryTest, TheNewRendererGetsTheScene) {
    ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_BRIDGED)));
    std::vector<float> positions(std::size_t{3} * 7, 0.25F);
    SluiceParticles particles = sevenAt(positions);
    const std::vector<float> pixels(std::size_t{3} * 2, 0.5F);
    auto environment = sized<SluiceEnvironment>();
    environment.width = 2;
    environment.height = 1;
    environment.pixels = pixels.data();
    ASSERT_TRUE(host_->setParticles(particles));
    ASSERT_TRUE(host_->setEnvironment(&environment));
    control_->lose_submit = 1;
    EXPECT_EQ(run(1), "-");
    control_->lose_submit = 0;
    // Given while there is no renderer: this is what the next one gets.
    particles.count = 5;
    ASSERT_TRUE(host_->setParticles(particles));
    positions.assign(positions.size(), 100.0F);
    EXPECT_EQ(run(1), "f");
    EXPECT_EQ(control_->particles, 5U);
    EXPECT_EQ(control_->first_coordinate, 0.25F);
    EXPECT_EQ(control_->environment_width, 2U);
    complaints_.clear();
}

TEST_F(RecoveryTest, PartsThatCannotBeAreRefusedAtOnceWhileThereIsNoRenderer) {
    ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_BRIDGED)));
    std::vector<float> positions(std::size_t{3} * 7, 0.25F);
    SluiceParticles particles = sevenAt(positions);
    ASSERT_TRUE(host_->setParticles(particles));
    control_->lose_submit = 1;
    EXPECT_EQ(run(1), "-");
    control_->lose_submit = 0;
    EXPECT_TRUE(host_->recovering());
    SluiceParticles none = particles;
    none.position = nullptr;
    EXPECT_THAT(host_->setParticles(none).error().message(), HasSubstr("NULL with a count of 7"));
    none = particles;
    none.radius = -1.0F;
    EXPECT_EQ(host_->setParticles(none).error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    none = particles;
    none.struct_size = 4;
    EXPECT_EQ(host_->setParticles(none).error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    none = particles;
    none.count = host_->info().capabilities.reserved[kMaxParticlesWord] + 1;  // none of which is read
    ASSERT_GT(none.count, 1U);
    EXPECT_THAT(host_->setParticles(none).error().message(), HasSubstr("this device takes at most"));
    auto environment = sized<SluiceEnvironment>();
    environment.width = environment.height = UINT32_MAX;
    environment.pixels = positions.data();
    EXPECT_EQ(host_->setEnvironment(&environment).error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    environment.pixels = nullptr;
    EXPECT_EQ(host_->setEnvironment(&environment).error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(run(2), "ff");
    EXPECT_FALSE(host_->recovering());
    EXPECT_EQ(control_->particles, 7U) << "what was there before stays";
    complaints_.clear();
}

TEST_F(RecoveryTest, APartThatANewRendererRefusesIsDroppedAndTheRestGoesOn) {
    ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_BRIDGED)));
    const std::vector<float> floats(std::size_t{3} * 7, 0.25F);
    auto particles = sized<SluiceParticles>();
    particles.count = 7;
    particles.radius = 0.5F;
    particles.position = floats.data();
    auto environment = sized<SluiceEnvironment>();
    environment.width = 2;
    environment.height = 1;
    environment.pixels = floats.data();
    for (const bool sky : {false, true}) {
        SCOPED_TRACE(sky);
        control_->lose_submit = sky ? 4 : 1;  // as the renderer counts
        EXPECT_EQ(run(1), "-");
        control_->lose_submit = 0;
        ASSERT_TRUE(host_->setParticles(particles));
        ASSERT_TRUE(host_->setEnvironment(&environment));
        complaints_.clear();
        control_->particles = control_->environment_width = 0;
        control_->refuses_particles_of = sky ? 0 : 7;
        control_->refuses_environment_of = sky ? 2 : 0;
        EXPECT_THAT(run(3), ::testing::EndsWith("ff"));
        EXPECT_EQ(control_->particles, sky ? 7U : 0U);
        EXPECT_EQ(control_->environment_width, sky ? 0U : 2U);
        EXPECT_THAT(complaints_,
                    ElementsAre(AllOf(HasSubstr(sky ? "environment set last: dropped" : "particles set last: dropped"),
                                      HasSubstr("the shim takes no such"))));
        complaints_.clear();
    }
    EXPECT_EQ(host_->renderers(), 3U);
}

TEST_F(RecoveryTest, ASimulationThatANewRendererRefusesIsDroppedAndTheRestGoesOn) {
    ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_BRIDGED)));
    control_->lose_submit = 1;
    EXPECT_EQ(run(1), "-");
    control_->lose_submit = 0;
    const std::vector<float> position(3, 0.25F);
    auto simulation = sized<SluiceSimulation>();
    simulation.particle_count = UINT32_MAX;  // none of which is read
    simulation.position = position.data();
    EXPECT_EQ(host_->setSimulation(&simulation).error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    simulation.particle_count = 1;
    ASSERT_TRUE(host_->setSimulation(&simulation));  // 0 iterations: only a renderer knows that this is wrong
    ASSERT_TRUE(host_->simulate(1, 0.0));
    EXPECT_EQ(run(2), "ff");
    EXPECT_TRUE(host_->simulate(2, 0.0)) << "nothing flows, as the log has said";
    EXPECT_EQ(run(1), "f");
    complaints_.clear();
}

/// In a box of 2 m; of several positions, the first.
SluiceSimulation oneParticleAt(const std::vector<float>& position) {
    auto simulation = sized<SluiceSimulation>();
    simulation.frames_in_flight = simulation.iterations = simulation.particle_count = 1;
    simulation.radius = 0.05F;
    simulation.relaxation = 0.1F;
    simulation.cfl = 0.4F;
    simulation.longest_step = 0.01;
    std::fill_n(&simulation.low[0], 3, -1.0F);
    std::fill_n(&simulation.high[0], 3, 1.0F);
    simulation.position = position.data();
    return simulation;
}

TEST_F(RecoveryTest, ANewRendererBeginsWithWhatTheSimulationWasResetTo) {
    ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_BRIDGED)));
    const std::vector<float> position{0.25F, 0.1F, 0.0F, 0.5F, 0.1F, 0.0F};
    auto start = sized<SluiceStart>();
    start.particle_count = 2;
    start.position = position.data();
    EXPECT_THAT(host_->resetSimulation(start).error().message(), HasSubstr("there is no simulation"));
    SluiceSimulation simulation = oneParticleAt(position);
    simulation.max_particles = 2;
    ASSERT_TRUE(host_->setSimulation(&simulation));
    ASSERT_TRUE(host_->simulate(1, 0.01));
    ASSERT_TRUE(host_->resetSimulation(start));
    ASSERT_TRUE(host_->simulate(2, 0.01));
    control_->lose_submit = 1;
    EXPECT_EQ(run(1), "-");
    control_->lose_submit = 0;
    complaints_.clear();
    EXPECT_EQ(run(2), "ff");
    EXPECT_THAT(complaints_,
                Contains(HasSubstr("from value 2 on it begins again, with what it was reset to for value 2")));
    ASSERT_TRUE(host_->waitForSimulation(2, 60'000'000'000));
    EXPECT_EQ(host_->simulationStats().value().particle_count, 2U);
    // While there is none it is only kept; what the next one refuses of it goes alone.
    control_->lose_submit = 3;
    EXPECT_EQ(run(1), "-");
    control_->lose_submit = 0;
    start.particle_count = 3;
    const std::vector<float> three(9, 0.1F);
    start.position = three.data();
    ASSERT_TRUE(host_->resetSimulation(start));
    complaints_.clear();
    EXPECT_EQ(run(3), "-ff");
    EXPECT_THAT(complaints_, Contains(HasSubstr("start set last: dropped")));
    EXPECT_EQ(host_->simulationStats().value().particle_count, 1U);
    complaints_.clear();
}

TEST_F(RecoveryTest, AChangedFlowGoesToTheNewRendererWithItsSimulation) {
    ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_BRIDGED)));
    const std::vector<float> position{0.0F, 0.1F, 0.0F};
    SluiceSimulation simulation = oneParticleAt(position);
    ASSERT_TRUE(host_->setSimulation(&simulation));
    auto flow = sized<SluiceFlow>();
    flow.iterations = 1;
    const auto loseIt = [this] {
        control_->lose_submit = kAnyFrame;
        EXPECT_EQ(run(1), "-");
        control_->lose_submit = 0;
        control_->flow_gravity = 0.0F;
    };
    // Each try comes twice as many frames after the one before, and the fourth is the last here.
    const auto nextOne = [this] { EXPECT_THAT(run(9), ::testing::EndsWith("f")); };
    flow.gravity[0] = 2.0F;
    ASSERT_TRUE(host_->setFlow(flow));
    EXPECT_EQ(control_->flow_gravity, 2.0F);
    loseIt();
    nextOne();
    EXPECT_EQ(control_->flow_gravity, 2.0F) << "what was set before";
    loseIt();
    flow.gravity[0] = 3.0F;
    ASSERT_TRUE(host_->setFlow(flow)) << "given while there is no renderer";
    EXPECT_EQ(control_->flow_gravity, 0.0F);
    nextOne();
    EXPECT_EQ(control_->flow_gravity, 3.0F);
    complaints_.clear();
    // One that only the new renderer can refuse is dropped, and said to be; the next one is taken.
    loseIt();
    flow.gravity[0] = control_->refuses_flow_of = 4.0F;
    ASSERT_TRUE(host_->setFlow(flow));
    nextOne();
    EXPECT_EQ(control_->flow_gravity, 0.0F);
    EXPECT_THAT(complaints_, Contains(HasSubstr("flow set last: dropped")));
    EXPECT_EQ(host_->setFlow(flow).error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    control_->refuses_flow_of = 0.0F;
    EXPECT_TRUE(host_->setFlow(flow));
    EXPECT_EQ(control_->flow_gravity, 4.0F);
    // Another simulation begins with its own.
    ASSERT_TRUE(host_->setSimulation(&simulation));
    loseIt();
    nextOne();
    EXPECT_EQ(control_->flow_gravity, 0.0F);
    complaints_.clear();
}

TEST_F(RecoveryTest, AFaultOfTheOrderCostsTwoFramesAndNotAllLater) {
    FluidHostConfig wanted = recovering(SLUICE_TIMELINE_FINISH);
    wanted.fault = FaultPlan{FaultKind::WrongValue, 3};
    ASSERT_NO_FATAL_FAILURE(begin(wanted));
    EXPECT_EQ(run(10), "fff--fffff");
    EXPECT_EQ(host_->renderers(), 2U);
    complaints_.clear();
}

TEST_F(RecoveryTest, DeadlinesThatPassInARowAreAFaultAndOneAloneIsNot) {
    FluidHostConfig wanted = recovering(SLUICE_TIMELINE_FINISH);
    ASSERT_NO_FATAL_FAILURE(begin(wanted));
    control_->time_out_from = 2;
    control_->time_out_to = 2;
    EXPECT_EQ(run(3), "f-f");
    EXPECT_EQ(host_->renderers(), 1U);
    control_->time_out_from = 4;
    control_->time_out_to = 100;
    EXPECT_EQ(run(2), "--");
    control_->time_out_from = control_->time_out_to = 0;
    EXPECT_EQ(run(2), "ff");
    EXPECT_EQ(host_->renderers(), 2U);
    complaints_.clear();
}

TEST_F(RecoveryTest, AnArgumentThatIsRefusedNeverCostsTheRenderer) {
    ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_BRIDGED)));
    FrameInput input = echoInput();
    input.camera.near_plane = -1.0F;
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(host_->submit(*screen_, input).error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    }
    EXPECT_EQ(host_->renderers(), 1U);
    EXPECT_TRUE(host_->submit(*screen_, echoInput()));
    EXPECT_TRUE(host_->composite(*screen_));
}

TEST_F(RecoveryTest, AResizeThatFindsNoMemoryIsMadeUpForByANewRenderer) {
    ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_BRIDGED)));
    EXPECT_EQ(run(2), "ff");
    control_->fail_resizes = 1;
    EXPECT_EQ(host_->resize(64, 48).error().code, SLUICE_ERROR_OUT_OF_MEMORY);
    ASSERT_NO_FATAL_FAILURE(makeScreen(64, 48));
    EXPECT_EQ(run(3), "fff");
    EXPECT_EQ(host_->info().width, 64U);
    complaints_.clear();
}

TEST_F(RecoveryTest, LeavesNoDescriptorBehindAndNothingForTheLedger) {
    const std::string path = std::filesystem::path(::testing::TempDir()) / "recovery.sluicelog";
    auto writer = ledger::LogWriter::create(path);
    ASSERT_TRUE(writer) << writer.error().message();
    ledger_ = std::make_unique<ledger::LiveLedger>(ledger::LedgerOptions{}, std::move(writer).value());
    FluidHostConfig wanted = recovering(SLUICE_TIMELINE_BRIDGED);
    wanted.ledger = ledger_.get();
    wanted.recovery.settled_frames = 1;
    ASSERT_NO_FATAL_FAILURE(begin(wanted));
    int settled = 0;
    for (int round = 0; round < 6; ++round) {
        EXPECT_EQ(run(2), "ff");
        control_->lose_submit = 3;  // as the renderer counts
        EXPECT_EQ(run(1), "-");
        control_->lose_submit = 0;
        if (round == 1) {
            settled = openDescriptors();
        }
    }
    EXPECT_TRUE(descriptorsReturnTo(settled)) << openDescriptors() << " instead of " << settled;
    EXPECT_EQ(run(1), "f");
    finish();
    EXPECT_THAT(found(), IsEmpty());
    int drains = 0;
    ledger::LogSink sink;
    sink.event = [&drains](const ledger::Event& event) {
        drains += event.kind == ledger::EventKind::Signal && event.object == ledger::kQueueDrains ? 1 : 0;
    };
    ASSERT_TRUE(ledger::readLog(path, sink));
    std::filesystem::remove(path);
    EXPECT_EQ(drains, 1) << "only the last of seven renderers had a device to wait for";
    complaints_.clear();
}

}  // namespace
}  // namespace sluice::host::test
