// SPDX-License-Identifier: MIT
// Schedule and report with numbers computed by hand.
#include <gmock/gmock.h>

#include "log_bytes.hpp"
#include "sluice/ledger/report.hpp"

namespace sluice::test {
namespace {

using ledger::Event;
using ledger::EventKind;
using ledger::kNone;
using ledger::Recording;
using ::testing::ElementsAre;

constexpr ledger::ActorId kGl = 0, kQueue = 1, kHost = 2;

Event in(std::uint32_t frame, Event event) {
    event.frame = frame;
    return event;
}

Recording recording(const std::vector<Event>& events, ledger::SyncKind kind = ledger::SyncKind::Timeline) {
    ledger::Recorder recorder;
    const ledger::LogSink sink = recorder.sink();
    sink.actor(kGl, ledger::ActorKind::GlContext, "gl");
    sink.actor(kQueue, ledger::ActorKind::VulkanQueue, "queue");
    sink.actor(kHost, ledger::ActorKind::HostThread, "host");
    sink.sync(0, kind, "ready", 0, 0);
    sink.sync(1, kind, "done", 0, 0);
    for (ledger::ObjectId more = 2; more < 5; ++more) {
        sink.sync(more, kind, "sync " + std::to_string(more), 0, 0);
    }
    sink.actor(3, ledger::ActorKind::BridgeThread, "bridge");
    sink.resource(0, "colour", 0, ledger::kNoActor);
    for (const Event& event : events) {
        sink.event(event);
    }
    return recorder.take({});
}

std::vector<std::uint32_t> signals(const Recording& made) {
    std::vector<std::uint32_t> found;
    const auto steps = ledger::schedule(made);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (made.events[i].event.kind == EventKind::Wait) {
            found.push_back(steps[i].signal);
        }
    }
    return found;
}

TEST(Schedule, ATimelinesWaitTakesTheFirstSignalThatReachesIt) {
    EXPECT_THAT(signals(recording({
                    event(EventKind::Wait, kQueue, 0, 2),  // before its signal
                    event(EventKind::Wait, kQueue, 0, 0),  // the initial value
                    event(EventKind::Signal, kGl, 0, 1),   // 2
                    event(EventKind::Signal, kGl, 0, 5),   // 3
                    event(EventKind::Signal, kGl, 0, 4),   // not increasing
                    event(EventKind::Wait, kQueue, 0, 1),  //
                    event(EventKind::Wait, kQueue, 0, 5),  //
                    event(EventKind::Wait, kQueue, 0, 6),  // nobody
                })),
                ElementsAre(3U, kNone, 2U, 3U, kNone));
}

TEST(Schedule, ABinarysWaitsTakeOneSignalEachAndAFencesAllTheFirst) {
    const std::vector<Event> events{
        event(EventKind::Signal, kGl, 0, 0), event(EventKind::Wait, kQueue, 0, 0), event(EventKind::Wait, kQueue, 0, 0),
        event(EventKind::Signal, kGl, 0, 0), event(EventKind::Wait, kQueue, 0, 0),
    };
    EXPECT_THAT(signals(recording(events, ledger::SyncKind::Binary)), ElementsAre(0U, 3U, kNone));
    EXPECT_THAT(signals(recording(events, ledger::SyncKind::Fence)), ElementsAre(0U, 0U, 0U));
}

TEST(Schedule, AFenceThatIsDeclaredAnewIsAnother) {
    ledger::Recorder recorder;
    const ledger::LogSink sink = recorder.sink();
    for (int i = 0; i < 2; ++i) {
        sink.sync(0, ledger::SyncKind::Fence, "fence", 0, 0);
        sink.event(event(EventKind::Signal, kGl, 0, 0));
        sink.event(event(EventKind::Wait, kHost, 0, 0));
    }
    EXPECT_THAT(signals(recorder.take({})), ElementsAre(0U, 2U));
}

TEST(Schedule, AWaitThatTimedOutHasNoSignal) {
    Event wait = event(EventKind::Wait, kHost, 0, 1);
    wait.flags = ledger::kTimedOut;
    EXPECT_THAT(signals(recording({event(EventKind::Signal, kGl, 0, 1), wait})), ElementsAre(kNone));
}

TEST(Schedule, AStreamRunsAfterItsSubmissionAndItsSignals) {
    const auto steps = ledger::schedule(recording({
        event(EventKind::Submit, kHost, kQueue, 1, 100),  //
        event(EventKind::Wait, kQueue, 0, 1, 90),         // logged before the submit returned
        event(EventKind::Signal, kQueue, 1, 1, 95),       //
        event(EventKind::Signal, kGl, 0, 1, 500),         //
        event(EventKind::Wait, kHost, 1, 1, 110, 420),    // measured: it woke 30 ns after the signal
    }));
    EXPECT_EQ(steps[1].begin_ns, 100U);
    EXPECT_EQ(steps[1].end_ns, 500U);
    EXPECT_EQ(steps[1].cause, 3U);
    EXPECT_EQ(steps[2].begin_ns, 500U);
    EXPECT_EQ(steps[4].end_ns, 530U);
    EXPECT_EQ(steps[4].cause, 2U);
}

TEST(Schedule, ACircleOfWaitsEnds) {
    const auto made = recording({
        event(EventKind::Wait, kQueue, 0, 1, 10),
        event(EventKind::Signal, kQueue, 1, 1, 20),
        event(EventKind::Wait, kGl, 1, 1, 30),
        event(EventKind::Signal, kGl, 0, 1, 40),
    });
    const auto steps = ledger::schedule(made);
    EXPECT_EQ(steps[0].end_ns, 10U) << "put where it was logged";
    EXPECT_EQ(steps[0].cause, kNone);
    EXPECT_EQ(ledger::makeReport(made, steps).frames.size(), 0U);
}

TEST(Schedule, AThreadThatStoodStillForAStreamsSignalKnowsWhenItCame) {
    const std::uint64_t held = ledger::kHeldNs;
    const auto steps = ledger::schedule(recording({
        event(EventKind::Signal, kGl, 0, 1, 100),             // recorded; 1: the thread waited for it
        event(EventKind::Write, kGl, 0, 1, 110),              // after it
        event(EventKind::Wait, kHost, 0, 1, 120, held),       //
        event(EventKind::Signal, kQueue, 1, 1, 200),          // there already when it was asked for
        event(EventKind::Wait, kHost, 1, 1, held * 2, 2000),  //
    }));
    EXPECT_EQ(steps[0].begin_ns, 100U);
    EXPECT_EQ(steps[0].end_ns, 120 + held);
    EXPECT_TRUE(steps[0].inferred);
    EXPECT_EQ(steps[1].begin_ns, 120 + held);
    EXPECT_EQ(steps[2].cause, 0U);
    EXPECT_EQ(steps[3].end_ns, 200U) << "a call that returns at once says nothing of when the signal came";
}

TEST(Schedule, TimesAtTheEndOfTheClockDoNotWrap) {
    const auto steps = ledger::schedule(recording({event(EventKind::Write, kGl, 0, 1, ~0ULL - 5, 100)}));
    EXPECT_EQ(steps[0].end_ns, ~0ULL);
}

TEST(Recording, FramesComeFromTheEventTheActorOrTheSubmission) {
    const Recording made = recording({
        event(EventKind::Frame, kHost, 0, 7), event(EventKind::Submit, kHost, kQueue, 1),
        event(EventKind::Read, kQueue, 0, 0),        // its submission's
        event(EventKind::Read, kGl, 0, 0),           // nobody has said
        in(9, event(EventKind::Read, kHost, 0, 0)),  // its own
        event(EventKind::Frame, kQueue, 0, 8),       //
        event(EventKind::Submit, kHost, kQueue, 2),  // 7 still
        event(EventKind::Read, kQueue, 0, 0),        // the queue has said 8
    });
    std::vector<std::uint32_t> frames;
    for (const auto& recorded : made.events) {
        frames.push_back(recorded.frame);
    }
    EXPECT_THAT(frames, ElementsAre(7U, 7U, 7U, 0U, 9U, 8U, 7U, 8U));
}

/// One frame of 420 ns. gl draws 50..200 and signals; the queue waits from 110, works 200..300 and signals; the host
/// feeds both, waits from 150 to 400 and reads at 420.
Recording oneFrame() {
    return recording({
        in(1, event(EventKind::Frame, kHost, 0, 1, 0)),          //
        in(1, event(EventKind::Write, kGl, 0, 1, 50, 100)),      //
        in(1, event(EventKind::Submit, kHost, kQueue, 1, 100)),  //
        in(1, event(EventKind::Wait, kQueue, 0, 1, 110)),        // 3: until 200
        in(1, event(EventKind::Signal, kQueue, 1, 1, 120)),      // 4: at 200, see the read below
        in(1, event(EventKind::WaitBegin, kHost, 1, 2, 150)),    //
        in(1, event(EventKind::Signal, kGl, 0, 1, 200)),         //
        in(1, event(EventKind::Read, kQueue, 0, 1, 210, 90)),    // until 300
        in(1, event(EventKind::Signal, kQueue, 1, 2, 215)),      // 8: at 300
        in(1, event(EventKind::Wait, kHost, 1, 2, 150, 250)),    // 9: until 400
        in(1, event(EventKind::Read, kHost, 0, 1, 420)),         //
    });
}

TEST(Report, OneFrameByHand) {
    const Recording made = oneFrame();
    const ledger::Report report = ledger::makeReport(made, ledger::schedule(made));
    ASSERT_EQ(report.frames.size(), 1U);
    const ledger::FrameReport& frame = report.frames[0];
    EXPECT_EQ(frame.frame, 1U);
    EXPECT_EQ(frame.begin_ns, 0U);
    EXPECT_EQ(frame.end_ns, 420U);

    ASSERT_EQ(frame.path.size(), 3U);
    EXPECT_EQ(frame.path[0].actor, kGl);
    EXPECT_EQ(frame.path[0].begin_ns, 50U);
    EXPECT_EQ(frame.path[0].entered_by, kNone);
    EXPECT_EQ(frame.path[1].actor, kQueue);
    EXPECT_EQ(frame.path[1].begin_ns, 200U);
    EXPECT_EQ(frame.path[1].end_ns, 300U);
    EXPECT_EQ(frame.path[1].entered_by, 3U);
    EXPECT_EQ(frame.path[2].actor, kHost);
    EXPECT_EQ(frame.path[2].begin_ns, 300U);
    EXPECT_EQ(frame.path[2].end_ns, 420U);
    EXPECT_EQ(frame.path[2].entered_by, 9U);

    ASSERT_EQ(frame.stalls.size(), 2U);
    EXPECT_EQ(frame.stalls[0].waiting, "host");
    EXPECT_EQ(frame.stalls[0].sync, "done");
    EXPECT_EQ(frame.stalls[0].signaller, "queue");
    EXPECT_EQ(frame.stalls[0].total_ns, 250U);
    EXPECT_EQ(frame.stalls[1].waiting, "queue");
    EXPECT_EQ(frame.stalls[1].total_ns, 90U);
    EXPECT_EQ(frame.stalled_ns, 340U);

    // Busy: gl 50..200, queue 200..300, host 0..150 and 400..420: 420 in all, 320 of them covered, 170 the longest.
    EXPECT_EQ(frame.overlap_achieved_ns, 100U);
    EXPECT_EQ(frame.overlap_possible_ns, 250U);

    // The queue's wait ends with its signal, the host's 100 ns after; only the host's was measured.
    EXPECT_EQ(frame.hand_off.count, 2U);
    EXPECT_EQ(frame.hand_off.min_ns, 0U);
    EXPECT_EQ(frame.hand_off.median_ns, 0U);
    EXPECT_EQ(frame.hand_off.p99_ns, 100U);
    EXPECT_EQ(frame.hand_off.max_ns, 100U);
    EXPECT_EQ(frame.wake_up.count, 1U);
    EXPECT_EQ(frame.wake_up.median_ns, 100U);
    EXPECT_EQ(report.frame_span.max_ns, 420U);
}

TEST(Report, WorkThatWaitedForItsSubmissionLeadsToTheThread) {
    const Recording made = recording({
        in(2, event(EventKind::Frame, kHost, 0, 2, 1000)),
        in(2, event(EventKind::Submit, kHost, kQueue, 1, 1100)),
        in(2, event(EventKind::Read, kQueue, 0, 1, 1090, 60)),
    });
    const auto path = ledger::makeReport(made, ledger::schedule(made)).frames.at(0).path;
    ASSERT_EQ(path.size(), 2U);
    EXPECT_EQ(path[0].actor, kHost);
    EXPECT_EQ(path[0].begin_ns, 1000U);
    EXPECT_EQ(path[1].actor, kQueue);
    EXPECT_EQ(path[1].begin_ns, 1100U);
    EXPECT_EQ(path[1].end_ns, 1150U);
}

/// What HandOffFeed tells of a bridged frame: host draws, fence, bridge, queue, host, composite, fence, bridge.
TEST(Report, TheBridgedFramesPathGoesThroughEveryHand) {
    constexpr ledger::ActorId kBridge = 3;
    constexpr ledger::ObjectId kFences = 2, kPromises = 3, kSubmissions = 4;
    constexpr std::uint64_t kMs = 1'000'000;
    const Recording made = recording({
        in(1, event(EventKind::Frame, kHost, 0, 1, 0)),
        in(1, event(EventKind::Submit, kHost, kGl, 1, 1 * kMs)),                    // the engine has drawn
        in(1, event(EventKind::Write, kGl, 0, 1, 1 * kMs)),                         // the capture
        in(1, event(EventKind::Signal, kGl, kFences, 1, 2 * kMs)),                  //
        in(1, event(EventKind::Signal, kHost, kPromises, 1, 2 * kMs)),              //
        in(1, event(EventKind::Signal, kHost, kSubmissions, 1, 2 * kMs + 1)),       //
        in(1, event(EventKind::Wait, kBridge, kPromises, 1, 0, 2 * kMs)),           // it slept
        in(1, event(EventKind::Wait, kBridge, kFences, 1, 2 * kMs + 10, 3 * kMs)),  // GL was at work until 5
        in(1, event(EventKind::Signal, kBridge, 0, 1, 5 * kMs + 20)),               //
        in(1, event(EventKind::Frame, kQueue, 0, 1, 0)),                            //
        in(1, event(EventKind::Wait, kQueue, kSubmissions, 1, 0)),                  //
        in(1, event(EventKind::Wait, kQueue, 0, 1, 2 * kMs + 1, 3 * kMs + 100)),    //
        in(1, event(EventKind::Signal, kQueue, 1, 1, 9 * kMs)),                     //
        in(1, event(EventKind::Wait, kHost, 1, 1, 3 * kMs, 6 * kMs + 50)),          //
        in(1, event(EventKind::Submit, kHost, kGl, 2, 9 * kMs + 60)),               //
        in(1, event(EventKind::Read, kGl, 0, 1, 9 * kMs + 61)),                     // the composite
        in(1, event(EventKind::Signal, kGl, kFences, 2, 9 * kMs + 70)),             //
        in(1, event(EventKind::Signal, kHost, kPromises, 2, 9 * kMs + 71)),
        in(1, event(EventKind::Wait, kBridge, kPromises, 2, 5 * kMs + 20, 4 * kMs + 60)),  // it slept again
        in(1, event(EventKind::Wait, kBridge, kFences, 2, 9 * kMs + 80, kMs)),             // until 10
        in(1, event(EventKind::Signal, kBridge, 0, 2, 10 * kMs + 90)),                     //
    });
    const ledger::FrameReport frame = ledger::makeReport(made, ledger::schedule(made)).frames.at(0);
    std::vector<std::uint32_t> actors;
    for (const ledger::PathPart& part : frame.path) {
        actors.push_back(part.actor);
    }
    EXPECT_THAT(actors, ElementsAre(kHost, kGl, kBridge, kQueue, kHost, kGl, kBridge));
    EXPECT_EQ(frame.path.front().begin_ns, 0U);
    EXPECT_EQ(frame.path[1].end_ns, 5 * kMs + 10);
    // The path's parts cover the frame.
    for (std::size_t i = 1; i < frame.path.size(); ++i) {
        EXPECT_EQ(frame.path[i].begin_ns, frame.path[i - 1].end_ns);
    }
    // The host beside OpenGL from 1 to 3 ms; a bridge that sleeps or waits runs beside nothing.
    EXPECT_EQ(frame.overlap_achieved_ns, 2 * kMs + 20);
}

TEST(Report, APathStopsWhereAnotherFrameHeldItUp) {
    const Recording made = recording({
        in(1, event(EventKind::Signal, kGl, 0, 1, 500)),
        in(2, event(EventKind::Wait, kQueue, 0, 1, 100)),
        in(2, event(EventKind::Read, kQueue, 0, 1, 510, 40)),
    });
    const auto report = ledger::makeReport(made, ledger::schedule(made));
    const auto& path = report.frames.at(1).path;
    ASSERT_EQ(path.size(), 1U);
    EXPECT_EQ(path[0].begin_ns, 500U);
    EXPECT_EQ(path[0].end_ns, 550U);
    EXPECT_EQ(path[0].entered_by, 1U);
    EXPECT_EQ(report.stalls.at(0).total_ns, 400U);
}

TEST(Report, StallsOfManyFramesAddUpByName) {
    std::vector<Event> events;
    for (std::uint32_t frame = 1; frame <= 3; ++frame) {
        const std::uint64_t t = 1000ULL * frame;
        events.push_back(in(frame, event(EventKind::Wait, kQueue, 0, frame, t)));
        events.push_back(in(frame, event(EventKind::Signal, kGl, 0, frame, t + 10ULL * frame)));
    }
    const Recording made = recording(events);
    const auto report = ledger::makeReport(made, ledger::schedule(made));
    ASSERT_EQ(report.stalls.size(), 1U);
    EXPECT_EQ(report.stalls[0].waits, 3U);
    EXPECT_EQ(report.stalls[0].total_ns, 60U);
    EXPECT_EQ(report.stalls[0].longest_ns, 30U);
    EXPECT_EQ(report.stalled_ns, 60U);
}

TEST(Report, DistributionsAreNearestRank) {
    std::vector<std::uint64_t> values;
    for (std::uint64_t i = 200; i > 0; --i) {
        values.push_back(i);
    }
    const auto d = ledger::distribution(values);
    EXPECT_EQ(d.count, 200U);
    EXPECT_EQ(d.min_ns, 1U);
    EXPECT_EQ(d.median_ns, 100U);
    EXPECT_EQ(d.p99_ns, 198U);
    EXPECT_EQ(d.max_ns, 200U);
    EXPECT_EQ(ledger::distribution({}).count, 0U);
    EXPECT_EQ(ledger::distribution({5}).p99_ns, 5U);
}

}  // namespace
}  // namespace sluice::test
