// SPDX-License-Identifier: MIT
// The ledger inside real frames: silent where the order is right, whatever else goes wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <ostream>
#include <tuple>

#include "ledger_rig.hpp"
#include "sluice/fd.hpp"
#include "sluice/format.hpp"

namespace sluice::host::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

/// For failure messages.
std::string told(const ledger::LiveLedger& ledger) {
    std::string text;
    for (const ledger::Finding& finding : ledger.findings()) {
        text += std::string(ledger::findingInfo(finding.kind).id) + ": " + finding.sentence + "\n";
    }
    return text;
}

class CleanFrames : public LedgerTest,
                    public ::testing::WithParamInterface<std::tuple<SluiceTimelineKind, std::uint32_t>> {};

TEST_P(CleanFrames, TwoHundredWithAResizeInTheMiddleAreWithoutAFinding) {
    const auto [kind, sets] = GetParam();
    ASSERT_NO_FATAL_FAILURE(start(kind, sets));
    frames(100);
    ASSERT_TRUE(host_->resize(67, 43));
    ASSERT_NO_FATAL_FAILURE(makeScreen(67, 43));
    frames(100);
    finish();
    EXPECT_EQ(fresh_, 200U) << stale_ << " stale, " << torn_ << " torn, " << without_fluid_ << " without fluid";
    EXPECT_THAT(ledger_->findings(), IsEmpty()) << told(*ledger_);
    // Each frame has at least two writes, two reads, and four times two acquires and releases.
    EXPECT_GT(ledger_->eventsSeen(), 200U * 20);
}

TEST_P(CleanFrames, FramesInFlightAreWithoutAFinding) {
    const auto [kind, sets] = GetParam();
    ASSERT_NO_FATAL_FAILURE(start(kind, sets));
    for (std::uint64_t i = 0; i < 120; ++i) {
        drawStamp(*screen_, i + 1, 4);
        const Status submitted = host_->submit(*screen_, echoInput());
        ASSERT_TRUE(submitted) << submitted.error().message();
        if ((i + 1) % sets == 0) {
            const Status composited = host_->composite(*screen_);
            ASSERT_TRUE(composited) << composited.error().message();
        }
    }
    ASSERT_TRUE(host_->stats(host_->frame()));
    finish();
    EXPECT_THAT(ledger_->findings(), IsEmpty()) << told(*ledger_);
}

TEST_P(CleanFrames, SubmitsThatFailAreNoFindings) {
    const auto [kind, sets] = GetParam();
    control_->fail_from = 5;
    control_->fail_to = 9;
    ASSERT_NO_FATAL_FAILURE(start(kind, sets));
    frames(20);
    finish();
    EXPECT_EQ(without_fluid_, 5U);
    EXPECT_EQ(fresh_, 15U);
    EXPECT_THAT(ledger_->findings(), IsEmpty()) << told(*ledger_);
}

TEST_P(CleanFrames, AWaitThatTimesOutIsThatFindingAndNoOther) {
    const auto [kind, sets] = GetParam();
    wait_timeout_ns_ = 1'500'000'000;
    control_->stall_value = 4;
    control_->stall_ms = 1'500;
    ASSERT_NO_FATAL_FAILURE(start(kind, sets));
    frames(20);
    finish();
    EXPECT_EQ(without_fluid_, 1U);
    EXPECT_THAT(found(), ElementsAre(Pair("wait-timed-out", 1U))) << told(*ledger_);
    ASSERT_FALSE(complaints_.empty());
    EXPECT_THAT(complaints_.front(), HasSubstr("for renderer-to-host >= 4 and goes on without the fluid"));
    EXPECT_THAT(complaints_.front(), HasSubstr("\n  renderer's queue has frame 4, submitted to wait for "
                                               "host-to-renderer >= 7"));
    complaints_.clear();
}

INSTANTIATE_TEST_SUITE_P(Software, CleanFrames,
                         ::testing::Combine(::testing::Values(SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH),
                                            ::testing::Values(1U, 2U, 3U)),
                         [](const auto& param) {
                             return std::string(toString(std::get<0>(param.param))) +
                                    std::to_string(std::get<1>(param.param));
                         });

TEST_F(LedgerTest, WithoutAnyWaitTheLedgerSeesRacesWhateverThePixelsSay) {
    flags_ = SLUICE_FRAME_SKIP_WAIT;
    ASSERT_NO_FATAL_FAILURE(start(SLUICE_TIMELINE_UNSYNCHRONISED, 2));
    frames(10);
    finish();
    EXPECT_THAT(found(), Contains(Pair("race-write-after-write", ::testing::Gt(0U)))) << told(*ledger_);
}

TEST_F(LedgerTest, MemoryIsBoundedOverTwoThousandFrames) {
    ASSERT_NO_FATAL_FAILURE(start(SLUICE_TIMELINE_BRIDGED, 2));
    ASSERT_TRUE(host_->resize(16, 16));
    ASSERT_NO_FATAL_FAILURE(makeScreen(16, 16));
    frames(1000, 1);
    const std::size_t first = ledger_->memoryBytes();
    frames(1000, 1);
    const std::size_t second = ledger_->memoryBytes();
    finish();
    std::printf("ledger: %zu bytes after 1000 frames, %zu after 2000, %llu events\n", first, second,
                static_cast<unsigned long long>(ledger_->eventsSeen()));
    EXPECT_LT(second, first + first / 4);
    EXPECT_THAT(ledger_->findings(), IsEmpty()) << told(*ledger_);
}

TEST_F(LedgerTest, ARendererThatTellsNothingIsToldOnceAndCostsNoMemory) {
    control_->mute = true;
    ASSERT_NO_FATAL_FAILURE(start(SLUICE_TIMELINE_BRIDGED, 2));
    frames(100, 1);
    const std::uint64_t events = ledger_->eventsSeen();
    frames(50, 1);
    EXPECT_EQ(ledger_->eventsSeen(), events + 50) << "nothing but this test's own Witness events";
    EXPECT_THAT(complaints_, ElementsAre(HasSubstr("the renderer sends no trace events of its queue")));
    complaints_.clear();
    finish();
    EXPECT_THAT(ledger_->findings(), IsEmpty()) << told(*ledger_);
    ASSERT_TRUE(ledger_->unchecked());
    EXPECT_EQ(ledger_->unchecked()->since_frame, 1U);
}

/// One thing about what crosses that is not so, and the one finding that says it.
struct Lie {
    const char* name;
    ImageLie image;
    InfoLie info;
    const char* finding;  ///< nullptr: none
};
void PrintTo(const Lie& lie, std::ostream* to) {
    *to << lie.name;
}

class SharedMemory : public LedgerTest, public ::testing::WithParamInterface<Lie> {};

TEST_P(SharedMemory, IsJudgedLiveAsItIsFromItsLog) {
    const std::string path =
        std::filesystem::path(::testing::TempDir()) / (std::string("shared_") + GetParam().name + ".sluicelog");
    auto writer = ledger::LogWriter::create(path);
    ASSERT_TRUE(writer) << writer.error().message();
    control_->image_lie = GetParam().image;
    control_->info_lie = GetParam().info;
    ASSERT_NO_FATAL_FAILURE(start(SLUICE_TIMELINE_BRIDGED, 2, std::nullopt, std::move(writer).value()));
    frames(3, 1);
    ASSERT_TRUE(host_->resize(67, 43));
    ASSERT_NO_FATAL_FAILURE(makeScreen(67, 43));
    frames(3, 1);
    finish();
    std::for_each_n(control_->lost.begin(), control_->lost_count, [](int fd) { UniqueFd{fd}.reset(); });
    EXPECT_EQ(control_->lost_count, GetParam().image == ImageLie::LostDescriptor ? 16U : 0U)
        << "two sets of four, twice";

    ledger::Ledger again;
    ASSERT_TRUE(ledger::readLog(path, ledger::sinkInto(again)));
    std::filesystem::remove(path);
    again.finish(ledger::End::Closed);
    const std::vector<ledger::Finding> live = ledger_->findings();
    ASSERT_EQ(again.findings().size(), live.size());
    for (std::size_t i = 0; i < live.size(); ++i) {
        EXPECT_EQ(again.findings()[i].sentence, live[i].sentence);
    }
    EXPECT_EQ(fresh_, 6U);
    if (GetParam().finding == nullptr) {
        EXPECT_THAT(found(), IsEmpty()) << told(*ledger_);
    } else {
        EXPECT_THAT(found(), ElementsAre(Pair(GetParam().finding, 16U))) << told(*ledger_);
    }
}

INSTANTIATE_TEST_SUITE_P(Software, SharedMemory,
                         ::testing::Values(Lie{"Right", ImageLie::None, InfoLie::None, nullptr},
                                           Lie{"NotDedicated", ImageLie::NotDedicated, InfoLie::None,
                                               "import-dedicated-mismatch"},
                                           Lie{"Larger", ImageLie::Larger, InfoLie::None, "import-size-mismatch"},
                                           Lie{"LostDescriptor", ImageLie::LostDescriptor, InfoLie::None, "fd-leaked"},
                                           Lie{"Device", ImageLie::None, InfoLie::Device, "import-uuid-mismatch"},
                                           Lie{"Driver", ImageLie::None, InfoLie::Driver, "import-uuid-mismatch"}),
                         [](const auto& param) { return std::string(param.param.name); });

TEST_F(LedgerTest, TheLogHoldsWhatTheLedgerWasTold) {
    const std::string path = std::filesystem::path(::testing::TempDir()) / "live.sluicelog";
    auto writer = ledger::LogWriter::create(path);
    ASSERT_TRUE(writer) << writer.error().message();
    ASSERT_NO_FATAL_FAILURE(start(SLUICE_TIMELINE_BRIDGED, 2, std::nullopt, std::move(writer).value()));
    frames(30);
    finish();
    ledger::Ledger again;
    const auto read = ledger::readLog(path, ledger::sinkInto(again));
    std::filesystem::remove(path);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read.value().end, ledger::End::Closed);
    EXPECT_EQ(read.value().events, ledger_->eventsSeen());
    again.finish(ledger::End::Closed);
    EXPECT_THAT(again.findings(), IsEmpty());
}

}  // namespace
}  // namespace sluice::host::test
