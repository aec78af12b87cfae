// SPDX-License-Identifier: MIT
// Which of two unordered accesses should have waited, and for what: the log may show them either way round.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "script.hpp"

namespace sluice::ledger::test {
namespace {

using testing::HasSubstr;

/// A hand-off in good order, so that the ledger has seen who waits for what.
void goodFrame(Script& s, std::uint64_t version) {
    s.write(kGl, kColour, version);
    s.signal(kGl, kHost, version);
    s.wait(kQueue, kHost, version);
    s.read(kQueue, kColour, version);
    s.signal(kQueue, kDone, version);
    s.wait(kEngine, kDone, version);
    s.submit(kEngine, kGl);
}

/// The race; what a reader of the wrong version is told besides is of no matter here.
const Finding& only(const Script& s) {
    static const Finding kNone;
    const Finding* race = nullptr;
    for (const Finding& found : s.ledger.findings()) {
        if (found.kind != FindingKind::StaleRead) {
            EXPECT_EQ(race, nullptr) << tell(s.ledger);
            race = &found;
        }
    }
    EXPECT_NE(race, nullptr);
    return race == nullptr ? kNone : *race;
}

TEST(LedgerRace, AReaderThatIsLoggedBeforeItsWriterIsTheOneThatShouldHaveWaited) {
    Script s;
    goodFrame(s, 1);
    s.read(kQueue, kColour, 2);
    s.write(kGl, kColour, 2);
    s.signal(kGl, kHost, 2);
    const Finding& found = only(s);
    EXPECT_EQ(found.kind, FindingKind::ReadAfterWrite);
    EXPECT_EQ(found.first.actor, kGl);
    EXPECT_EQ(found.second.actor, kQueue);
    EXPECT_THAT(found.sentence, HasSubstr("queue reads colour"));
    EXPECT_THAT(found.sentence, HasSubstr("nothing orders that after the write of version 2 by gl"));
    EXPECT_EQ(found.edge, "gl:signal(host-to-renderer, 2) -> queue:wait(host-to-renderer, 2)");
    EXPECT_THAT(found.remedy, HasSubstr("Let queue wait for host-to-renderer >= 2 before the read of colour by queue"));
}

TEST(LedgerRace, AWriterThatIsLoggedBeforeTheReaderOfTheVersionBeforeShouldHaveWaitedForIt) {
    Script s;
    goodFrame(s, 1);
    s.write(kGl, kColour, 2);
    s.signal(kGl, kHost, 2);
    s.write(kGl, kColour, 3);  // does not wait for the reader of 2
    s.wait(kQueue, kHost, 2);
    s.read(kQueue, kColour, 2);
    s.signal(kQueue, kDone, 2);
    const Finding& found = only(s);
    EXPECT_EQ(found.kind, FindingKind::WriteAfterRead);
    EXPECT_THAT(found.sentence, HasSubstr("gl writes colour"));
    EXPECT_EQ(found.edge, "queue:signal(renderer-to-host, 2) -> engine:wait(renderer-to-host, 2)")
        << "the engine's thread waits and then feeds gl";
}

TEST(LedgerRace, WithoutVersionsTheEarlierFrameComesFirst) {
    Script s;
    s.event(EventKind::Frame, kGl, kNoObject, 3);
    s.event(EventKind::Frame, kQueue, kNoObject, 2);
    s.write(kGl, kColour);
    s.read(kQueue, kColour);
    EXPECT_EQ(only(s).kind, FindingKind::WriteAfterRead);
    EXPECT_THAT(only(s).sentence, HasSubstr("gl writes colour in frame 3, but nothing orders that after the read by "
                                            "queue in frame 2."));
}

TEST(LedgerRace, WhoeverTakesBackWhatItGaveAwayShouldHaveWaitedForTheOther) {
    Script s;
    goodFrame(s, 1);
    s.write(kGl, kColour, 2);
    s.release(kGl, kColour, 1, 1);
    s.signal(kGl, kHost, 2);
    s.acquire(kGl, kColour, 1, 1);  // too early; its read below is as well, and needs no second word
    s.read(kGl, kColour);
    s.wait(kQueue, kHost, 2);
    s.acquire(kQueue, kColour, 1, 1);
    s.write(kQueue, kColour, 2);
    s.release(kQueue, kColour, 1, 1);
    s.signal(kQueue, kDone, 2);
    s.wait(kEngine, kDone, 2);
    s.submit(kEngine, kGl);
    s.write(kGl, kColour, 3);  // it has the image: it need not acquire it again
    s.release(kGl, kColour, 1, 1);
    const Finding& found = only(s);
    EXPECT_THAT(found.sentence, HasSubstr("gl acquires colour"));
    EXPECT_THAT(found.sentence, HasSubstr("nothing orders that after the release by queue"));
    EXPECT_EQ(found.first.kind, EventKind::Release);
    EXPECT_EQ(found.edge, "queue:signal(renderer-to-host, 2) -> engine:wait(renderer-to-host, 2)");
}

TEST(LedgerRace, TakingBackWhatNobodyTookIsRight) {
    Script s;
    for (std::uint64_t frame = 1; frame <= 3; ++frame) {
        s.write(kGl, kColour, frame);
        s.release(kGl, kColour, 1, 1);
        if (frame != 2) {
            s.acquire(kGl, kColour, 1, 1);
            continue;
        }
        s.signal(kGl, kHost, frame);
        s.wait(kQueue, kHost, frame);
        s.acquire(kQueue, kColour, 1, 1);
        s.release(kQueue, kColour, 1, 1);
        s.signal(kQueue, kDone, frame);
        s.wait(kGl, kDone, frame);
        s.acquire(kGl, kColour, 1, 1);
    }
    EXPECT_EQ(tell(s.ledger), "");
}

TEST(LedgerRace, ABridgesSignalIsNamedAndNotTheFenceThatItWaitsFor) {
    Script s;
    s.ledger.declareSync(7, SyncKind::Timeline, "GL fences", 0, 0);
    const auto bridged = [&s](std::uint64_t value, bool wait) {
        s.write(kGl, kColour, value);
        s.signal(kGl, 7, value);
        if (!wait) {
            s.wait(kQueue, kHost, value - 1);
            s.write(kQueue, kColour, value);  // before the bridge's signal
        }
        s.wait(kBridge, 7, value);
        s.signal(kBridge, kHost, value);
        if (wait) {
            s.wait(kQueue, kHost, value);
            s.write(kQueue, kColour, value);
            s.signal(kQueue, kDone, value);
            s.wait(kGl, kDone, value);
        }
    };
    bridged(1, true);
    bridged(2, false);
    ASSERT_THAT(kinds(s.ledger), testing::Contains(FindingKind::WriteAfterWrite));
    for (const Finding& found : s.ledger.findings()) {
        if (found.kind == FindingKind::WriteAfterWrite) {
            EXPECT_EQ(found.edge, "bridge:signal(host-to-renderer, 2) -> queue:wait(host-to-renderer, 2)");
            EXPECT_THAT(found.remedy, HasSubstr("bridge signals that after the write by gl"));
        }
    }
}

/// gl's picture goes through the queue back to gl; the queue does not wait for it when `skip` says so.
void echo(Script& s, std::uint64_t frame, bool skip, Verdict verdict) {
    s.event(EventKind::Frame, kGl, kNoObject, frame);
    s.event(EventKind::Frame, kQueue, kNoObject, frame);
    s.write(kGl, kColour, frame);
    s.signal(kGl, kHost, frame);
    if (!skip) {
        s.wait(kQueue, kHost, frame);
    }
    s.read(kQueue, kColour, frame);
    s.write(kQueue, kDepth, frame);
    s.signal(kQueue, kDone, frame);
    s.wait(kGl, kDone, frame);
    s.read(kGl, kDepth, frame);
    s.witness(kGl, kDepth, frame, verdict);
}

TEST(LedgerRace, WrongPixelsOfARacedInputAreNotTheDriversFault) {
    Script s;
    echo(s, 1, false, Verdict::Fresh);
    echo(s, 2, true, Verdict::Stale);
    echo(s, 3, false, Verdict::Fresh);
    s.ledger.finish(End::Closed);
    EXPECT_THAT(kinds(s.ledger), testing::Contains(FindingKind::ReadAfterWrite)) << tell(s.ledger);
    EXPECT_THAT(kinds(s.ledger), testing::Not(testing::Contains(FindingKind::DriverReordered))) << tell(s.ledger);
    // In the next frame the race is no excuse any more.
    echo(s, 4, false, Verdict::Stale);
    s.ledger.finish(End::Closed);
    EXPECT_THAT(kinds(s.ledger), testing::Contains(FindingKind::DriverReordered)) << tell(s.ledger);
}

TEST(LedgerBounds, AnActorThatStandsStillForeverIsLostAndThatIsSaid) {
    LedgerOptions options;
    options.max_held = 1000;
    Script s(options);
    s.write(kGl, kColour, 1);
    s.wait(kEngine, kDone, 99);   // nobody ever signals it
    s.wait(kBridge, kBinary, 0);  // nor this, and nothing more comes from the bridge
    std::size_t peak = 0;
    for (std::uint64_t i = 1; i <= 20'000; ++i) {
        s.submit(kEngine, kGl);
        s.read(kEngine, kDepth);
        s.write(kGl, kColour, i);
        s.signal(kGl, kHost, i);
        // A fence of each frame is declared anew.
        s.ledger.declareSync(kFence, SyncKind::Fence, "fence", 0, 0);
        s.signal(kQueue, kFence, 1);
        peak = i == 4000 ? s.ledger.memoryBytes() : peak;
    }
    EXPECT_LE(s.ledger.memoryBytes(), peak + (std::size_t{64} << 10U));
    s.ledger.finish(End::Closed);
    const auto unheard = s.ledger.unheard();
    ASSERT_GE(unheard.size(), 2U) << "the engine's thread, and gl, which it feeds";
    EXPECT_THAT(tell(s.ledger), testing::Not(HasSubstr("race")));
    std::string why;
    for (const Unheard& one : unheard) {
        why += one.why + "\n";
    }
    EXPECT_THAT(why, HasSubstr("engine waits for renderer-to-host >= 99"));
    EXPECT_THAT(why, HasSubstr("1000 events were kept back for it"));
}

TEST(LedgerBounds, AQueueThatWasNeverHeardIsSaid) {
    Script s;
    s.write(kGl, kColour, 1);
    s.event(EventKind::ActorEnd, kQueue, kNoObject, 0, 0, kUntold);
    std::string why;
    for (const Unheard& one : s.ledger.unheard()) {
        why += one.why + "; ";
    }
    EXPECT_EQ(why, "queue: told nothing; queue2: is declared and does nothing here; ");
}

TEST(LedgerRace, RacesThatNobodyEverSignalsForCostNoMemory) {
    Script s;
    for (ObjectId resource = 10; resource < 200; ++resource) {
        s.write(kGl, resource, 1);
        s.write(kQueue, resource, 1);
    }
    const std::size_t before = s.ledger.memoryBytes();
    for (std::uint64_t value = 1; value < 500; ++value) {
        s.signal(kEngine, kHost, value);
    }
    EXPECT_EQ(s.ledger.findings().size(), 190U);
    EXPECT_LT(s.ledger.memoryBytes(), before + (std::size_t{64} << 10U));
    EXPECT_THAT(s.ledger.findings().back().edge, HasSubstr("gl:signal(after write of resource 199)"));
}

}  // namespace
}  // namespace sluice::ledger::test
