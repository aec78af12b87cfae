// SPDX-License-Identifier: MIT
// What a session does to a host besides frames: resizing, restarting, skipping, failing.
#include <epoxy/gl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "compositor/linear_depth.hpp"
#include "echo_rig.hpp"
#include "gl_test.hpp"
#include "hostile_state.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/host_gl/state_snapshot.hpp"

namespace sluice::host::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

class LifecycleTest : public EchoTest {};

TEST_F(LifecycleTest, FollowsAStormOfResizes) {
    FluidHostConfig wanted = config();
    wanted.validation = true;
    ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
    for (std::uint32_t i = 0; i < 24; ++i) {
        const std::uint32_t width = i == 7 ? 1 : 17 + (i * 97) % 301;
        const std::uint32_t height = i == 7 ? 1 : 5 + (i * 61) % 199;
        const Status resized = host_->resize(width, height);
        ASSERT_TRUE(resized) << resized.error().message();
        EXPECT_EQ(host_->info().width, width);
        ASSERT_NO_FATAL_FAILURE(makeScreen(width, height));
        for (std::uint32_t frame = 0; frame <= i % 3; ++frame) {
            ASSERT_NO_FATAL_FAILURE(frameIsClean()) << width << "x" << height;
        }
    }
    EXPECT_EQ(host_->stats(host_->frame()).value().validation_messages, 0U);
}

TEST_F(LifecycleTest, TwentyHostsLeaveNoDescriptorBehind) {
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    int settled = 0;
    for (int i = 0; i < 20; ++i) {
        ASSERT_NO_FATAL_FAILURE(makeHost(config()));
        ASSERT_NO_FATAL_FAILURE(frameIsClean());
        host_.reset();
        // Drivers may keep some descriptors from the first time on.
        if (i == 1) {
            settled = openDescriptors();
        }
    }
    EXPECT_EQ(openDescriptors(), settled);
}

TEST_F(LifecycleTest, AHundredCanariesLeaveNoDescriptorBehind) {
    const ProbeServices probe([](SluiceLogLevel, std::string_view) {});
    auto info = sized<SluiceCreateInfo>();
    info.width = kEchoWidth;
    info.height = kEchoHeight;
    info.image_sets = 1;
    info.host = queryCapabilities();
    int settled = 0;
    for (int i = 0; i < 100; ++i) {
        auto error = sized<SluiceError>();
        const std::uint32_t format = i % 2 == 0 ? SLUICE_FORMAT_R32F : SLUICE_FORMAT_D32F;
        ASSERT_EQ(library_->api().probe_format(&probe.services(), &info, format, 67, 43, &error), SLUICE_OK)
            << error.message;
        if (i == 3) {
            settled = openDescriptors();
        }
    }
    EXPECT_EQ(openDescriptors(), settled);
}

TEST_F(LifecycleTest, FramesWithoutCompositeDoNotStopTheNext) {
    FluidHostConfig wanted = config();
    wanted.validation = true;
    ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    for (int i = 0; i < 7; ++i) {
        drawStamp(*screen_, host_->frame() + 1, 4);
        const Status submitted = host_->submit(*screen_, echoInput());
        ASSERT_TRUE(submitted) << submitted.error().message();
    }
    ASSERT_NO_FATAL_FAILURE(frameIsClean());
    EXPECT_EQ(host_->frame(), 8U);
    const Status twice = host_->composite(*screen_);
    ASSERT_FALSE(twice);
    EXPECT_THAT(twice.error().message(), HasSubstr("no submitted frame waits"));
    EXPECT_EQ(host_->stats(host_->frame()).value().validation_messages, 0U);
}

TEST_F(LifecycleTest, AFrameThatTheRendererRefusesIsTheHostsAlone) {
    ASSERT_NO_FATAL_FAILURE(makeHost(config()));
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    for (std::uint64_t k = 1; k <= 6; ++k) {
        drawStamp(*screen_, k, 4);
        FrameInput input = echoInput();
        if (k == 3) {
            input.camera.near_plane = -1.0F;
        }
        const Status submitted = host_->submit(*screen_, input);
        ASSERT_EQ(submitted.ok(), k != 3);
        // Other colours and the far plane: what the composite leaves alone shows.
        drawStamp(*screen_, 1000 + k, 1);
        glClearDepth(1.0);
        glClear(GL_DEPTH_BUFFER_BIT);
        const std::vector<float> colour = readColour(*screen_, nullptr).values;
        const std::vector<float> depth = readDepth(*screen_, nullptr).values;
        const Status composited = host_->composite(*screen_);
        EXPECT_EQ(composited.ok(), k != 3);
        EXPECT_EQ(readColour(*screen_, nullptr).values == colour, k == 3) << "frame " << k;
        EXPECT_EQ(readDepth(*screen_, nullptr).values == depth, k == 3) << "frame " << k;
        if (k != 3) {
            EXPECT_TRUE(inspect(*host_, k).clean()) << "frame " << k;
        } else {
            EXPECT_THAT(submitted.error().message(), HasSubstr("renderer submit_frame: camera planes"));
        }
    }
}

TEST_F(LifecycleTest, AWaitThatTimesOutLeavesTheScreenAloneAndTheHostUsable) {
    FluidHostConfig wanted = config();
    wanted.timeline = SLUICE_TIMELINE_BRIDGED;
    wanted.wait_timeout_ns = 1000;
    ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    drawStamp(*screen_, 1, 600);
    ASSERT_TRUE(host_->submit(*screen_, echoInput()));
    const Status late = host_->composite(*screen_);
    ASSERT_FALSE(late);
    EXPECT_EQ(late.error().code, SLUICE_TIMEOUT);
    // Both sets are free again once the renderer is done; until then the host is told so, and its numbers do not move.
    bool accepted = false;
    for (int i = 0; i < 1000 && !accepted; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        accepted = host_->submit(*screen_, echoInput()).ok() && host_->frame() >= 3;
    }
    EXPECT_TRUE(accepted);
}

TEST_F(LifecycleTest, ScreenOfAnotherSizeIsRefusedByName) {
    ASSERT_NO_FATAL_FAILURE(makeHost(config()));
    ASSERT_NO_FATAL_FAILURE(makeScreen(10, 20));
    const Status status = host_->submit(*screen_, echoInput());
    ASSERT_FALSE(status);
    EXPECT_THAT(status.error().message(), HasSubstr("expected a screen of 259x131, found 10x20"));
    EXPECT_EQ(host_->resize(0, 5).error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    ASSERT_NO_FATAL_FAILURE(frameIsClean());
}

TEST_F(LifecycleTest, LinearFallbackCarriesMetres) {
    FluidHostConfig wanted = config();
    wanted.host_depth = SLUICE_FORMAT_R32F;
    ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
    ASSERT_EQ(host_->info().host_depth_encoding, static_cast<std::uint32_t>(SLUICE_DEPTH_LINEAR));
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    drawStamp(*screen_, 1, 4);
    const FrameInput input = echoInput();
    ASSERT_TRUE(host_->submit(*screen_, input));
    ASSERT_TRUE(host_->composite(*screen_));
    const Pixels metres =
        readTexture(host_->texture(SLUICE_IMAGE_HOST_DEPTH), SLUICE_FORMAT_R32F, kEchoWidth, kEchoHeight, nullptr);
    for (std::size_t i = 0; i < metres.values.size(); ++i) {
        const double ndc = 2.0 * double{stampOf(1, i % kEchoWidth < kEchoWidth / 2 ? 0 : 1).depth} - 1.0;
        const double expected = -double{input.camera.projection[14]} / (-ndc - double{input.camera.projection[10]});
        // 24-bit depth itself is good to 6e-8 / (n/z)-ish; at these depths (z < 2 m) that is below 1e-5 of z.
        ASSERT_NEAR(double{metres.values[i]} / expected, 1.0, 1e-5) << "texel " << i;
    }
}

TEST_F(LifecycleTest, SubmitAndCompositeLeaveAHostileStateAsFound) {
    for (const SluiceFormat format : {SLUICE_FORMAT_D32F, SLUICE_FORMAT_R32F}) {
        FluidHostConfig wanted = config();
        wanted.host_depth = format;
        Trace trace(1024);
        wanted.trace = &trace;
        ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
        ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
        drawStamp(*screen_, 1, 4);
        const HostileState hostile(screen_->framebuffer());
        while (glGetError() != GL_NO_ERROR) {
        }
        const StateSnapshot before = takeStateSnapshot();
        const Status submitted = host_->submit(*screen_, echoInput());
        EXPECT_THAT(differences(before, takeStateSnapshot()), IsEmpty());
        const Status composited = host_->composite(*screen_);
        EXPECT_THAT(differences(before, takeStateSnapshot()), IsEmpty());
        EXPECT_TRUE(submitted && composited);
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
        if (format == SLUICE_FORMAT_D32F) {
            EXPECT_TRUE(inspect(*host_, 1).clean());
        }
        host_.reset();
        // A context of its own for the next round.
        screen_.reset();
        context_.reset();
        Result<GlContext> context = GlContext::create();
        ASSERT_TRUE(context);
        context_.emplace(std::move(context).value());
        ASSERT_TRUE(context_->makeCurrent());
    }
}

TEST_F(LifecycleTest, TheTraceOfAFrameShowsEveryStepAndNoCopyByTheCpu) {
    Trace trace(4096);
    FluidHostConfig wanted = config();
    wanted.timeline = SLUICE_TIMELINE_BRIDGED;
    wanted.trace = &trace;
    ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    static_cast<void>(trace.drain());
    constexpr std::uint64_t kFrames = 6;
    for (std::uint64_t k = 1; k <= kFrames; ++k) {
        drawStamp(*screen_, k, 4);
        ASSERT_TRUE(host_->submit(*screen_, echoInput()));
        ASSERT_TRUE(host_->composite(*screen_));
    }
    host_.reset();
    const std::vector<TraceRecord> records = trace.drain();
    EXPECT_EQ(totals(records).count[SLUICE_TRACE_CPU_COPY], 0U);
    EXPECT_EQ(totals(records).bytes[SLUICE_TRACE_CPU_COPY], 0U);
    std::vector<std::uint64_t> to_renderer;
    std::uint64_t submits = 0;
    std::uint64_t passes = 0;
    std::uint64_t acquires = 0;
    std::uint64_t releases = 0;
    for (const TraceRecord& record : records) {
        const bool host = record.track == SLUICE_TRACK_HOST_CPU;
        if (record.kind == SLUICE_TRACE_SIGNAL && record.direction == SLUICE_HOST_TO_RENDERER) {
            EXPECT_EQ(record.track, SLUICE_TRACK_BRIDGE);
            to_renderer.push_back(record.value);
        }
        submits += host && record.kind == SLUICE_TRACE_SUBMIT ? 1 : 0;
        passes += record.track == SLUICE_TRACK_HOST_GL && record.kind == SLUICE_TRACE_PASS ? 1 : 0;
        acquires += host && record.kind == SLUICE_TRACE_ACQUIRE ? 1 : 0;
        releases += host && record.kind == SLUICE_TRACE_RELEASE ? 1 : 0;
        if (host && record.kind == SLUICE_TRACE_RELEASE) {
            EXPECT_GE(record.bytes, std::uint64_t{kEchoWidth} * kEchoHeight * 4);
        }
    }
    std::vector<std::uint64_t> expected;
    for (std::uint64_t value = 1; value <= 2 * kFrames; ++value) {
        expected.push_back(value);
    }
    EXPECT_EQ(to_renderer, expected);
    EXPECT_EQ(submits, kFrames);
    EXPECT_EQ(passes, 2 * kFrames) << "capture and composite of every frame, the last one's too";
    // Four images a set: given up once a frame, taken at first use and at each composite.
    EXPECT_EQ(releases, 4 * kFrames);
    EXPECT_EQ(acquires, 4 * (kFrames + 2));
}

}  // namespace
}  // namespace sluice::host::test
