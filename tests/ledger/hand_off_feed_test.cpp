// SPDX-License-Identifier: MIT
// The protocol's steps as the feed tells them, for every kind of timeline, without a driver: the queue's events come as
// late as they may.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "sluice/format.hpp"
#include "sluice/ledger/hand_off_feed.hpp"
#include "sluice/ledger/recording.hpp"
#include "sluice/roles.hpp"
#include "sluice/timeline.hpp"
#include "sluice/trace.hpp"

namespace sluice::ledger {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Key;

/// What goes wrong, and in which frame.
struct Mistake {
    std::uint64_t frame = 0;
    bool queue_skips_wait = false, host_skips_wait = false, names_left_out = false, submit_fails = false;
    bool queue_mute = false;  ///< from that frame on
    bool reads_depth_early = false, captures_early = false;
};

class Rig {
  public:
    Rig(SluiceTimelineKind kind, std::uint32_t sets, Mistake mistake = {})
        : kind_(kind), sets_(sets), mistake_(mistake), feed_(std::make_unique<HandOffFeed>(ledger, kind, sets)) {
        feed_->imagesMade(kAlwaysSharedRoles);
    }

    /// The queue's events of a frame are told when its set is used again, or at the end.
    void frames(std::uint64_t count) {
        for (std::uint64_t i = 0; i < count; ++i) {
            frame(next_++);
        }
    }
    /// Frames capture their depth for a fluid, which reads that of the frame before; two buffers take turns.
    void simulate() {
        feed_->simulationMade(2);
        simulates_ = true;
    }
    void resize(bool drained = true) {
        tellQueue(0);
        feed_->glFinished(monotonicNanoseconds());
        feed_->imagesDestroyed(drained);
        feed_->imagesMade(kAlwaysSharedRoles);
    }
    void end() {
        tellQueue(0);
        feed_.reset();
        EXPECT_TRUE(ledger.finish(End::Closed));
    }
    std::map<std::string, std::string> found() const {
        std::map<std::string, std::string> ids;
        for (const Finding& finding : ledger.findings()) {
            ids[std::string(findingInfo(finding.kind).id)] += finding.sentence + " " + finding.edge + "\n";
        }
        return ids;
    }
    HandOffFeed& feed() { return *feed_; }
    int wentBlind() const { return went_blind_; }

    LiveLedger ledger;

  private:
    void frame(std::uint64_t k) {
        const bool wrong = k == mistake_.frame;
        feed_->captureBegins(k);
        feed_->captureEnds(k);
        signal(gbufferWritten(k), !(wrong && mistake_.names_left_out));
        tellQueue(sets_ - 1);
        if (!feed_->submits(k)) {
            ++went_blind_;
        }
        if (wrong && mistake_.submit_fails) {
            feed_->takenBack(k);
            return;
        }
        late_.push_back(k);
        if (simulates_) {
            fluid(k + 1);
        }
        if (!(wrong && mistake_.host_skips_wait)) {
            wait(fluidWritten(k));
        }
        feed_->compositeReads(k);
        if (kind_ != SLUICE_TIMELINE_BINARY) {
            signal(compositeRead(k), false);
        }
    }
    void signal(std::uint64_t value, bool names) {
        switch (kind_) {
            case SLUICE_TIMELINE_BRIDGED:
                feed_->fencePromised(value);
                feed_->bridgeWaited(value, 0, monotonicNanoseconds(), true);
                return feed_->bridgeSignals(value);
            case SLUICE_TIMELINE_FINISH:
                feed_->glFinished(monotonicNanoseconds());
                return feed_->hostSignals(value);
            default:
                return feed_->glSignals(value, names);
        }
    }
    void wait(std::uint64_t value) {
        if (kind_ == SLUICE_TIMELINE_NATIVE || kind_ == SLUICE_TIMELINE_BINARY) {
            return feed_->glWaits(value, true);
        }
        feed_->hostWaits(value);
        feed_->hostWaited(value, monotonicNanoseconds(), false);
    }
    void tellQueue(std::size_t leave) {
        while (late_.size() > leave) {
            if (!(mistake_.queue_mute && late_.front() >= mistake_.frame)) {
                queue(late_.front());
            }
            late_.pop_front();
        }
    }
    /// Value v takes the depth of frame v - 1 and lets go of that before.
    void fluid(std::uint64_t value) {
        const std::uint64_t seen = value - 1;
        if (!(mistake_.frame == seen && mistake_.reads_depth_early)) {
            trace(SLUICE_TRACE_WAIT, value, seen, "depth captured", SLUICE_TRACK_SIMULATION);
        }
        trace(SLUICE_TRACE_ACQUIRE, value, seen, depthName(seen), SLUICE_TRACK_SIMULATION);
        if (seen > 1) {
            trace(SLUICE_TRACE_RELEASE, value, seen - 1, depthName(seen - 1), SLUICE_TRACK_SIMULATION);
        }
    }
    static const char* depthName(std::uint64_t frame) {
        return frame % 2 == 0 ? "CAPTURED_DEPTH 0" : "CAPTURED_DEPTH 1";
    }
    void trace(SluiceTraceKind kind, std::uint64_t frame, std::uint64_t value, const char* name,
               SluiceTrack track = SLUICE_TRACK_RENDERER_QUEUE) {
        SluiceTraceEvent event{};
        event.struct_size = sizeof(event);
        event.kind = kind;
        event.track = track;
        event.begin_ns = monotonicNanoseconds();
        event.frame = frame;
        event.value = value;
        event.name = name;
        feed_->trace(event);
    }
    void queue(std::uint64_t k) {
        constexpr std::array kImages{"HOST_COLOUR", "HOST_DEPTH", "FLUID_COLOUR", "FLUID_DEPTH"};
        if (!(k == mistake_.frame && mistake_.queue_skips_wait)) {
            trace(SLUICE_TRACE_WAIT, k, gbufferWritten(k), "queue waits for host");
        }
        if (simulates_) {
            const bool early = k == mistake_.frame && mistake_.captures_early;
            trace(SLUICE_TRACE_ACQUIRE, k, k > 2 && !early ? k - 2 : 0, depthName(k));
        }
        for (const char* image : kImages) {
            trace(SLUICE_TRACE_ACQUIRE, k, 0, image);
        }
        trace(SLUICE_TRACE_PASS, k, 0, "shade");
        if (simulates_) {
            trace(SLUICE_TRACE_RELEASE, k, k, depthName(k));
        }
        for (const char* image : kImages) {
            trace(SLUICE_TRACE_RELEASE, k, 0, image);
        }
        trace(SLUICE_TRACE_SIGNAL, k, fluidWritten(k), "queue signals host");
    }

    SluiceTimelineKind kind_;
    std::uint32_t sets_;
    Mistake mistake_;
    std::unique_ptr<HandOffFeed> feed_;
    std::uint64_t next_ = 1;
    std::deque<std::uint64_t> late_;
    bool simulates_ = false;
    int went_blind_ = 0;
};

class HandOffFeedOf : public ::testing::TestWithParam<std::tuple<SluiceTimelineKind, std::uint32_t>> {
  protected:
    SluiceTimelineKind kind_ = std::get<0>(GetParam());
    std::uint32_t sets_ = std::get<1>(GetParam());
};

TEST_P(HandOffFeedOf, IsSilentAboutCleanFramesAResizeAndAFailedSubmit) {
    Mistake failure;
    failure.frame = 7;
    failure.submit_fails = true;
    Rig rig(kind_, sets_, failure);
    rig.frames(20);
    rig.resize();
    rig.frames(20);
    rig.end();
    EXPECT_THAT(rig.found(), IsEmpty());
    EXPECT_GT(rig.ledger.eventsSeen(), 40U * 20);
    EXPECT_FALSE(rig.ledger.unchecked());
    EXPECT_EQ(rig.wentBlind(), 0);
}

TEST_P(HandOffFeedOf, AQueueThatTellsNothingIsNotChecked) {
    for (const std::uint64_t count : {5U, 100U}) {
        Mistake mute;
        mute.frame = 1;
        mute.queue_mute = true;
        Rig rig(kind_, sets_, mute);
        rig.frames(count);
        rig.end();
        EXPECT_THAT(rig.found(), IsEmpty());
        ASSERT_TRUE(rig.ledger.unchecked());
        EXPECT_EQ(rig.ledger.unchecked()->since_frame, 1U);
        EXPECT_EQ(rig.wentBlind(), count > 64 ? 1 : 0);
    }
}

TEST_P(HandOffFeedOf, AQueueThatFallsSilentIsCheckedUpToThere) {
    Mistake mute;
    mute.frame = 10;
    mute.queue_mute = true;
    Rig rig(kind_, sets_, mute);
    rig.frames(100);
    rig.end();
    EXPECT_THAT(rig.found(), IsEmpty());
    ASSERT_TRUE(rig.ledger.unchecked());
    EXPECT_EQ(rig.ledger.unchecked()->since_frame, 10U);
    EXPECT_EQ(rig.wentBlind(), 1);
}

TEST_P(HandOffFeedOf, TellsOfTheWaitThatTheHostLeftOut) {
    Mistake skip;
    skip.frame = 6;
    skip.host_skips_wait = true;
    Rig rig(kind_, sets_, skip);
    rig.frames(12);
    rig.end();
    // However late the queue tells of itself: the host comes after the renderer.
    auto found = rig.found();
    ASSERT_THAT(found, Contains(Key("race-write-after-write")));
    EXPECT_THAT(found["race-write-after-write"],
                HasSubstr("but nothing orders that after the release by renderer's queue in frame 6."));
    if (kind_ != SLUICE_TIMELINE_BINARY) {
        EXPECT_THAT(found["race-write-after-write"], HasSubstr(":signal(renderer-to-host, 6) -> "));
    }
    EXPECT_THAT(found["race-write-after-write"], ::testing::Not(HasSubstr("renderer's queue acquires")));
    EXPECT_EQ(found.count("ownership-mismatch"), 0U) << found["ownership-mismatch"];
}

TEST_P(HandOffFeedOf, TellsOfTheWaitThatTheQueueLeftOutUnlessTheSubmissionImpliesIt) {
    Mistake skip;
    skip.frame = 6;
    skip.queue_skips_wait = true;
    Rig rig(kind_, sets_, skip);
    rig.frames(12);
    rig.end();
    if (kind_ == SLUICE_TIMELINE_FINISH) {
        EXPECT_THAT(rig.found(), IsEmpty());
    } else {
        auto found = rig.found();
        ASSERT_THAT(found, Contains(Key("race-write-after-write")));
        EXPECT_THAT(found["race-write-after-write"], HasSubstr("renderer's queue acquires HOST_COLOUR"));
        EXPECT_THAT(found["race-write-after-write"], ::testing::Not(HasSubstr("GL fences")));
        if (kind_ != SLUICE_TIMELINE_BINARY) {
            EXPECT_THAT(found["race-write-after-write"], HasSubstr("-> renderer's queue:wait(host-to-renderer, 11)"));
        }
    }
}

TEST_P(HandOffFeedOf, TellsOfTexturesThatAGlSignalDoesNotName) {
    Mistake unnamed;
    unnamed.frame = 6;
    unnamed.names_left_out = true;
    Rig rig(kind_, sets_, unnamed);
    rig.frames(12);
    rig.end();
    if (kind_ == SLUICE_TIMELINE_NATIVE || kind_ == SLUICE_TIMELINE_BINARY) {
        EXPECT_THAT(rig.found(), Contains(Key("resource-not-listed")));
    } else {
        EXPECT_THAT(rig.found(), IsEmpty());
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, HandOffFeedOf,
                         ::testing::Combine(::testing::Values(SLUICE_TIMELINE_NATIVE, SLUICE_TIMELINE_BINARY,
                                                              SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH),
                                            ::testing::Values(1U, 2U, 4U)),
                         [](const auto& param) {
                             return std::string(sluice::toString(std::get<0>(param.param))) +
                                    std::to_string(std::get<1>(param.param));
                         });

TEST(HandOffFeed, ACapturedDepthIsReadAfterItsFrameAndCapturedIntoAfterThat) {
    Mistake early_read;
    early_read.frame = 6;
    early_read.reads_depth_early = true;
    Mistake early_capture;
    early_capture.frame = 6;
    early_capture.captures_early = true;
    for (const std::uint32_t sets : {1U, 2U, 4U}) {
        const auto found = [sets](const Mistake& mistake) {
            Rig rig(SLUICE_TIMELINE_BRIDGED, sets, mistake);
            rig.simulate();
            rig.frames(12);
            rig.end();
            EXPECT_FALSE(rig.ledger.unchecked());
            return rig.found();
        };
        EXPECT_THAT(found({}), IsEmpty()) << sets;
        auto read = found(early_read);
        EXPECT_EQ(read.size(), 2U) << ::testing::PrintToString(read);
        EXPECT_THAT(read["stale-read"], HasSubstr("ordered after the write of version 4 by renderer's queue"));
        EXPECT_THAT(read["race-read-after-write"],
                    AllOf(HasSubstr("simulation reads captured depth 0"), HasSubstr("(version 6)"),
                          HasSubstr("renderer's queue:signal(frames that drew, 6) -> simulation:wait(frames that drew, "
                                    "6)")))
            << sets;
        auto capture = found(early_capture);
        EXPECT_EQ(capture.size(), 1U);
        EXPECT_THAT(capture["race-write-after-read"],
                    AllOf(HasSubstr("renderer's queue writes captured depth 0 in frame 6"),
                          HasSubstr("captured depths that are free")))
            << sets;
    }
}

TEST(HandOffFeed, TheChainNamesTheFenceThatTheBridgeWaitsFor) {
    Rig rig(SLUICE_TIMELINE_BRIDGED, 2);
    rig.frames(3);
    rig.feed().captureBegins(4);
    rig.feed().captureEnds(4);
    rig.feed().fencePromised(7);
    ASSERT_TRUE(rig.feed().submits(4));
    rig.feed().hostWaits(4);
    EXPECT_THAT(rig.feed().waitForChain(4),
                AllOf(HasSubstr("renderer's queue has frame 4, submitted to wait for host-to-renderer >= 7, which has "
                                "reached 6"),
                      HasSubstr("bridge thread would signal 7, but waits for the GL fence of value 7")));
}

TEST(HandOffFeed, TheChainNamesASignalThatWasNeverRecordedAndAFrameThatWasNeverSubmitted) {
    Rig rig(SLUICE_TIMELINE_BRIDGED, 2);
    rig.frames(3);
    rig.feed().captureBegins(4);
    rig.feed().captureEnds(4);
    ASSERT_TRUE(rig.feed().submits(4));
    EXPECT_THAT(rig.feed().waitForChain(4), HasSubstr("nobody has promised host-to-renderer 7"));
    EXPECT_THAT(rig.feed().waitForChain(5), HasSubstr("frame 5 has not been submitted; the last one is 4"));
}

/// The times that diagnose works with: no sleep counts as work, and none reaches back before its frame.
TEST(HandOffFeed, BridgeAndQueueStandStillUntilTheyAreFed) {
    const std::string path = std::filesystem::path(::testing::TempDir()) / "fed.sluicelog";
    auto log = LogWriter::create(path);
    ASSERT_TRUE(log) << log.error().message();
    LiveLedger ledger(LedgerOptions{}, std::move(log).value());
    const std::uint64_t before = monotonicNanoseconds();
    {
        HandOffFeed feed(ledger, SLUICE_TIMELINE_BRIDGED, 2);
        feed.imagesMade(kAlwaysSharedRoles);
        feed.captureBegins(1, before);
        feed.captureEnds(1);
        feed.fencePromised(1);
        feed.bridgeWaited(1, before - 1'000'000, monotonicNanoseconds(), true);
        feed.bridgeSignals(1);
        ASSERT_TRUE(feed.submits(1));
        SluiceTraceEvent event{};
        event.struct_size = sizeof(event);
        event.track = SLUICE_TRACK_RENDERER_QUEUE;
        event.kind = SLUICE_TRACE_WAIT;
        event.frame = event.value = 1;
        event.begin_ns = monotonicNanoseconds();
        feed.trace(event);
    }
    ASSERT_TRUE(ledger.finish(End::Closed));
    const auto read = loadRecording(path);
    std::filesystem::remove(path);
    ASSERT_TRUE(read) << read.error().message();
    const RecordedEvent* slept = nullptr;
    const RecordedEvent* stood = nullptr;
    for (const RecordedEvent& one : read.value().events) {
        EXPECT_TRUE(one.event.time_ns >= before) << toString(one.event.kind);
        if (one.event.kind == EventKind::Wait) {
            (one.event.actor == kBridgeThread && one.event.object == kPromises ? slept : stood) = &one;
        }
        if (one.event.kind == EventKind::Frame && one.event.actor == kHostThread) {
            EXPECT_EQ(one.event.time_ns, before) << "the frame begins with the engine's draw";
        }
    }
    ASSERT_NE(slept, nullptr);
    EXPECT_EQ(slept->event.time_ns, before) << "cut to its frame";
    EXPECT_GT(slept->event.duration_ns, 0U);
    ASSERT_NE(stood, nullptr);
    EXPECT_EQ(stood->event.actor, kRendererQueue);
    EXPECT_EQ(stood->event.object, kHostToRenderer);
}

/// The lives of one host's renderers in one log: frames go on as the host counts them, and names tell who was whose.
TEST(HandOffFeed, AnotherRendererGoesOnWithTheHostsFramesUnderItsOwnName) {
    const std::string path = std::filesystem::path(::testing::TempDir()) / "lives.sluicelog";
    auto log = LogWriter::create(path);
    ASSERT_TRUE(log) << log.error().message();
    LiveLedger ledger(LedgerOptions{}, std::move(log).value());
    for (const RendererLife life : {RendererLife{1, 0}, RendererLife{2, 3}}) {
        ledger.rendererBegins(life);
        HandOffFeed feed(ledger, SLUICE_TIMELINE_BRIDGED, 2);
        feed.captureBegins(1);
        feed.captureEnds(1);
        ASSERT_TRUE(feed.submits(1));
        EXPECT_THAT(feed.waitForChain(1), HasSubstr(life.number == 1 ? "has frame 1, " : "has frame 4, "));
    }
    EXPECT_EQ(ledger.unchecked()->since_frame, 1U);
    ASSERT_TRUE(ledger.finish(End::Closed));
    const auto read = loadRecording(path);
    std::filesystem::remove(path);
    ASSERT_TRUE(read) << read.error().message();
    std::map<std::string, std::uint32_t> frame;
    for (const RecordedEvent& one : read.value().events) {
        if (one.event.kind == EventKind::Frame) {
            EXPECT_EQ(one.event.value, one.frame);
            frame[read.value().actors.at(one.actor).name] = one.frame;
        }
    }
    EXPECT_THAT(frame,
                ::testing::ElementsAre(std::pair("GL stream", 1U), std::pair("GL stream, 2nd renderer", 4U),
                                       std::pair("host thread", 1U), std::pair("host thread, 2nd renderer", 4U)));
    EXPECT_EQ((RendererLife{11, 0}.nameOf("x") + RendererLife{23, 0}.nameOf("y")), "x, 11th renderery, 23rd renderer");
}

TEST(HandOffFeed, OnlyAQueueThatWasWaitedForIsThroughWithTheImages) {
    for (const bool drained : {true, false}) {
        Mistake skip;
        skip.frame = 3;
        skip.host_skips_wait = true;
        Rig rig(SLUICE_TIMELINE_BRIDGED, 2, skip);
        rig.frames(3);
        rig.resize(drained);
        rig.end();
        EXPECT_EQ(rig.found().count("use-after-destroy"), drained ? 0U : 1U) << "drained: " << drained;
    }
}

TEST(HandOffFeed, AWaitThatWasGivenUpIsNoFinding) {
    Rig rig(SLUICE_TIMELINE_BRIDGED, 2);
    rig.frames(3);
    rig.feed().hostWaits(4);
    rig.feed().hostGaveUp(4, monotonicNanoseconds());
    rig.end();
    EXPECT_THAT(rig.found(), IsEmpty());
}

TEST(HandOffFeed, EventsOfOtherTracksAndUnknownImagesAreNothing) {
    Rig rig(SLUICE_TIMELINE_BRIDGED, 2);
    const std::uint64_t before = rig.ledger.eventsSeen();
    SluiceTraceEvent event{};
    event.struct_size = sizeof(event);
    event.frame = 1;
    event.track = SLUICE_TRACK_HOST_CPU;
    event.kind = SLUICE_TRACE_SIGNAL;
    rig.feed().trace(event);
    EXPECT_EQ(rig.ledger.eventsSeen(), before);
}

}  // namespace
}  // namespace sluice::ledger
