// SPDX-License-Identifier: MIT
// A thousand frames between the real drivers: every texel belongs to its frame, and does not once the waits are gone.
#include <gtest/gtest.h>

#include <cstdio>

#include "echo_rig.hpp"
#include "sluice/format.hpp"

namespace sluice::host::test {
namespace {

constexpr std::uint64_t kFrames = 1000;
constexpr int kLayers = 24;

/// A bad frame is stale if every texel is that of one or more earlier frames, else torn (or never written).
struct Tally {
    std::uint64_t frames = 0, bad = 0, stale = 0, torn = 0;
};

class HandOffTest : public EchoTest {
  protected:
    /// One body for every backend: draws, hands over, composites, and looks at every texel.
    void run(std::uint64_t frames, int layers, std::uint32_t flags, Tally& tally) {
        FrameInput input = echoInput();
        input.flags = flags;
        for (std::uint64_t i = 0; i < frames; ++i) {
            const std::uint64_t frame = host_->frame() + 1;
            drawStamp(*screen_, frame, layers);
            const Status submitted = host_->submit(*screen_, input);
            ASSERT_TRUE(submitted) << submitted.error().message();
            ASSERT_EQ(host_->frame(), frame);
            const Status composited = host_->composite(*screen_);
            ASSERT_TRUE(composited) << composited.error().message();
            const Verdict verdict = inspect(*host_, frame);
            ASSERT_EQ(verdict.texels, std::size_t{kEchoWidth} * kEchoHeight);
            ++tally.frames;
            tally.bad += verdict.clean() ? 0U : 1U;
            const bool whole = verdict.stale == verdict.texels;
            tally.stale += whole ? 1U : 0U;
            tally.torn += !verdict.clean() && !whole ? 1U : 0U;
        }
    }
};

class SynchronisedHandOff : public HandOffTest, public ::testing::WithParamInterface<SluiceTimelineKind> {};

TEST_P(SynchronisedHandOff, AThousandFramesWithoutAStaleOrTornTexelOrAValidationMessage) {
    FluidHostConfig wanted = config();
    wanted.timeline = GetParam();
    wanted.validation = true;
    ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
    ASSERT_EQ(host_->info().timeline, static_cast<std::uint32_t>(GetParam()));
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    Tally tally;
    ASSERT_NO_FATAL_FAILURE(run(kFrames, kLayers, 0, tally));
    EXPECT_EQ(tally.frames, kFrames);
    EXPECT_EQ(tally.bad, 0U);
    const Result<SluiceFrameStats> stats = host_->stats(host_->frame());
    ASSERT_TRUE(stats) << stats.error().message();
    EXPECT_EQ(stats.value().validation_messages, 0U);
    EXPECT_EQ(stats.value().cpu_copy_bytes, 0U);
}

INSTANTIATE_TEST_SUITE_P(Software, SynchronisedHandOff,
                         ::testing::Values(SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH),
                         [](const auto& kind) { return std::string(toString(kind.param)); });

TEST_F(HandOffTest, TheSameBodyWithoutWaitsSeesBadFrames) {
    FluidHostConfig wanted = config();
    wanted.timeline = SLUICE_TIMELINE_UNSYNCHRONISED;
    ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    Tally tally;
    // A race need not be lost at once: more work per frame until it is.
    for (int layers = kLayers; layers <= 64 * kLayers && tally.bad == 0; layers *= 4) {
        ASSERT_NO_FATAL_FAILURE(run(100, layers, SLUICE_FRAME_SKIP_WAIT, tally));
    }
    EXPECT_GT(tally.bad, 0U);
    std::printf("without waits: %llu of %llu frames bad (%llu stale, %llu torn)\n",
                static_cast<unsigned long long>(tally.bad), static_cast<unsigned long long>(tally.frames),
                static_cast<unsigned long long>(tally.stale), static_cast<unsigned long long>(tally.torn));
}

}  // namespace
}  // namespace sluice::host::test
