// SPDX-License-Identifier: MIT
// Timelines that fail at start-up, and devices that get lost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shim_rig.hpp"
#include "timeline/fallback.hpp"

namespace sluice::host::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::uint32_t bit(SluiceTimelineKind kind) {
    return 1U << kind;
}

TEST(TimelineFallback, GoesFromTheBestKindDownAndNeverToNoWaitsAtAll) {
    EXPECT_THAT(timelinesAfter(SLUICE_TIMELINE_NATIVE),
                ElementsAre(SLUICE_TIMELINE_BINARY, SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH));
    EXPECT_THAT(timelinesAfter(SLUICE_TIMELINE_BINARY), ElementsAre(SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH));
    EXPECT_THAT(timelinesAfter(SLUICE_TIMELINE_BRIDGED), ElementsAre(SLUICE_TIMELINE_FINISH));
    EXPECT_THAT(timelinesAfter(SLUICE_TIMELINE_FINISH), IsEmpty());
    EXPECT_THAT(timelinesAfter(SLUICE_TIMELINE_AUTO), IsEmpty());
    EXPECT_THAT(timelinesAfter(SLUICE_TIMELINE_UNSYNCHRONISED), IsEmpty());
    EXPECT_THAT(timelinesAfter(SLUICE_TIMELINE_KIND_COUNT), IsEmpty());
}

class FaultTest : public ShimTest {};

TEST_F(FaultTest, AutoFallsBackToTheNextKindThatStarts) {
    control_->lies = bit(SLUICE_TIMELINE_NATIVE) | bit(SLUICE_TIMELINE_BINARY);
    ASSERT_NO_FATAL_FAILURE(makeHost(config()));
    EXPECT_EQ(host_->info().timeline, static_cast<std::uint32_t>(SLUICE_TIMELINE_BRIDGED));
    ASSERT_EQ(control_->attempt_count, 3U);
    EXPECT_EQ(control_->attempts[0], static_cast<std::uint32_t>(SLUICE_TIMELINE_AUTO));
    EXPECT_EQ(control_->attempts[1], static_cast<std::uint32_t>(SLUICE_TIMELINE_BINARY));
    EXPECT_EQ(control_->attempts[2], static_cast<std::uint32_t>(SLUICE_TIMELINE_BRIDGED));
    EXPECT_EQ(control_->destroys, 2U);
    EXPECT_THAT(
        complaints_,
        ElementsAre(AllOf(HasSubstr("timeline native failed at start-up, binary is next: "), HasSubstr("GL")),
                    AllOf(HasSubstr("timeline binary failed at start-up, bridged is next: "), HasSubstr("GL"))));
    complaints_.clear();
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    for (int i = 0; i < 5; ++i) {
        ASSERT_NO_FATAL_FAILURE(frameIsClean());
    }
}

TEST_F(FaultTest, AutoAlsoPassesOverKindsThatTheRendererRefuses) {
    control_->lies = bit(SLUICE_TIMELINE_NATIVE);
    control_->refuses = bit(SLUICE_TIMELINE_BINARY) | bit(SLUICE_TIMELINE_BRIDGED);
    ASSERT_NO_FATAL_FAILURE(makeHost(config()));
    EXPECT_EQ(host_->info().timeline, static_cast<std::uint32_t>(SLUICE_TIMELINE_FINISH));
    EXPECT_EQ(control_->attempt_count, 4U);
    EXPECT_EQ(complaints_.size(), 3U);
    complaints_.clear();
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    ASSERT_NO_FATAL_FAILURE(frameIsClean());
}

TEST_F(FaultTest, AutoFailsWithTheLastReasonWhenNothingStarts) {
    control_->lies = bit(SLUICE_TIMELINE_NATIVE);
    control_->refuses = bit(SLUICE_TIMELINE_BINARY) | bit(SLUICE_TIMELINE_BRIDGED) | bit(SLUICE_TIMELINE_FINISH);
    const auto host = FluidHost::create(*library_, config());
    ASSERT_FALSE(host);
    EXPECT_THAT(host.error().message(), HasSubstr("the shim refuses this timeline"));
    EXPECT_EQ(control_->attempt_count, 4U);
}

TEST_F(FaultTest, AForcedKindDoesNotFallBack) {
    for (const SluiceTimelineKind kind : {SLUICE_TIMELINE_NATIVE, SLUICE_TIMELINE_BINARY}) {
        resetShim();
        control_->lies = bit(kind);
        FluidHostConfig wanted = config();
        wanted.timeline = kind;
        EXPECT_FALSE(FluidHost::create(*library_, wanted));
        EXPECT_EQ(control_->attempt_count, 1U);
        EXPECT_EQ(control_->destroys, 1U);
    }
}

TEST_F(FaultTest, AFailureThatIsNotTheTimelinesDoesNotFallBack) {
    control_->refuses = bit(SLUICE_TIMELINE_AUTO);
    EXPECT_FALSE(FluidHost::create(*library_, config()));
    EXPECT_EQ(control_->attempt_count, 1U);
}

TEST_F(FaultTest, AFaultThatWouldHangAWaitOfOpenGLIsRefused) {
    for (const FaultKind kind : {FaultKind::Drop, FaultKind::Swap, FaultKind::Duplicate}) {
        for (const SluiceTimelineKind timeline : {SLUICE_TIMELINE_NATIVE, SLUICE_TIMELINE_BINARY}) {
            EXPECT_FALSE(checkFault({kind, 1, SLUICE_HOST_TO_RENDERER}, timeline));
        }
        EXPECT_TRUE(checkFault({kind, 1, SLUICE_HOST_TO_RENDERER}, SLUICE_TIMELINE_BRIDGED));
        EXPECT_TRUE(checkFault({kind, 1, SLUICE_RENDERER_TO_HOST}, SLUICE_TIMELINE_NATIVE));
    }
    EXPECT_TRUE(checkFault({FaultKind::Delay, 1, SLUICE_HOST_TO_RENDERER}, SLUICE_TIMELINE_NATIVE));
    control_->lies = bit(SLUICE_TIMELINE_NATIVE);
    FluidHostConfig wanted = config();
    wanted.fault = FaultPlan{FaultKind::Drop, 1};
    const auto refused = FluidHost::create(*library_, wanted);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), AllOf(HasSubstr("native"), HasSubstr("--timeline bridged")));
    EXPECT_EQ(control_->attempt_count, 1U) << "auto does not go on to a timeline that nobody asked for";
}

TEST_F(FaultTest, AFaultWhoseFrameNeverCameIsSaid) {
    for (const std::uint64_t frame : {2U, 3U}) {
        FluidHostConfig wanted = config();
        wanted.timeline = SLUICE_TIMELINE_BRIDGED;
        wanted.fault = FaultPlan{FaultKind::Delay, frame, SLUICE_HOST_TO_RENDERER, 1};
        ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
        ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
        ASSERT_NO_FATAL_FAILURE(frameIsClean());
        ASSERT_NO_FATAL_FAILURE(frameIsClean());
        host_.reset();
        if (frame == 2) {
            EXPECT_THAT(complaints_, IsEmpty());
        } else {
            EXPECT_THAT(complaints_, ElementsAre(HasSubstr("frame 3 never came, the last one was 2")));
        }
        complaints_.clear();
    }
}

TEST_F(FaultTest, AfterALossInSubmitNothingIsWaitedForAndTheScreenIsLeftAlone) {
    FluidHostConfig wanted = config();
    wanted.timeline = SLUICE_TIMELINE_BRIDGED;
    ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    ASSERT_NO_FATAL_FAILURE(frameIsClean());
    ASSERT_NO_FATAL_FAILURE(frameIsClean());
    control_->lose_submit = 3;
    drawStamp(*screen_, 3, 1);
    const std::vector<float> before = readColour(*screen_, nullptr).values;
    EXPECT_EQ(host_->submit(*screen_, echoInput()).error().code, SLUICE_ERROR_DEVICE_LOST);
    const std::uint32_t waits = control_->waits;
    EXPECT_EQ(control_->submits, 3U);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(host_->composite(*screen_).error().code, SLUICE_ERROR_DEVICE_LOST);
        const Status next = host_->submit(*screen_, echoInput());
        ASSERT_FALSE(next);
        EXPECT_THAT(next.error().message(), HasSubstr("the renderer has lost its device"));
    }
    EXPECT_EQ(control_->waits, waits);
    EXPECT_EQ(control_->submits, 3U) << "a lost renderer is left alone";
    EXPECT_EQ(readColour(*screen_, nullptr).values, before);
}

TEST_F(FaultTest, AfterALossInPollTheFrameIsNotWaitedFor) {
    FluidHostConfig wanted = config();
    wanted.timeline = SLUICE_TIMELINE_BRIDGED;
    ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    drawStamp(*screen_, 1, 1);
    ASSERT_TRUE(host_->submit(*screen_, echoInput()));
    control_->lose_poll = 1;
    EXPECT_EQ(host_->stats(1).error().code, SLUICE_ERROR_DEVICE_LOST);
    const Status composited = host_->composite(*screen_);
    ASSERT_FALSE(composited);
    EXPECT_EQ(composited.error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_EQ(control_->waits, 0U);
}

}  // namespace
}  // namespace sluice::host::test
