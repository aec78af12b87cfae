// SPDX-License-Identifier: MIT
// The flow of events: held actors, submissions, what is told while it runs, and runs without end.
#include <chrono>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "script.hpp"

namespace sluice::ledger::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(LedgerFlow, WaitBeforeSignalIsJudgedWhenTheSignalComes) {
    Script s;
    s.wait(kQueue, kHost, 1);
    s.read(kQueue, kColour, 1);
    s.wait(kQueue2, kDone, 1);
    s.write(kQueue2, kDepth, 1);
    s.signal(kQueue, kDone, 1);
    EXPECT_EQ(s.ledger.blocked().size(), 2U);
    s.write(kGl, kColour, 1);
    s.signal(kGl, kHost, 1);
    EXPECT_THAT(s.ledger.blocked(), IsEmpty());
    s.ledger.finish(End::Closed);
    EXPECT_EQ(tell(s.ledger), "");
}

TEST(LedgerFlow, WhatAHeldActorDidIsStillJudged) {
    Script s;
    s.wait(kQueue, kHost, 1);
    s.read(kQueue, kDepth);  // nothing orders it after the write below
    s.write(kGl, kColour, 1);
    s.signal(kGl, kHost, 1);
    s.write(kGl, kDepth, 1);
    EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::WriteAfterRead)) << tell(s.ledger);
}

TEST(LedgerFlow, SubmissionOrdersAStreamAfterItsThread) {
    Script s;
    s.write(kEngine, kColour, 1);
    s.submit(kEngine, kQueue);
    s.read(kQueue, kColour, 1);
    s.write(kEngine, kDepth, 1);  // after the submission: not given with it
    s.read(kQueue, kDepth, 1);
    EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::ReadAfterWrite)) << tell(s.ledger);
}

TEST(LedgerFlow, SubmissionOfAHeldThreadHoldsTheStream) {
    Script s;
    s.wait(kEngine, kHost, 1);
    s.write(kEngine, kColour, 1);
    s.submit(kEngine, kQueue);
    s.read(kQueue, kColour, 1);
    s.signal(kQueue, kDone, 1);
    s.wait(kQueue2, kDone, 1);
    EXPECT_THAT(s.ledger.waitChain(kQueue2),
                ElementsAre("queue2 waits for renderer-to-host >= 1, which has reached 0; queue would signal it, but "
                            "stands behind a wait:",
                            "queue waits for submission 0 of engine, which comes after:",
                            "engine waits for host-to-renderer >= 1, which has reached 0; nobody has ever signalled "
                            "it"));
    s.signal(kGl, kHost, 1);
    EXPECT_THAT(s.ledger.waitChain(kQueue2), IsEmpty());
    s.ledger.finish(End::Closed);
    EXPECT_EQ(tell(s.ledger), "");
}

TEST(LedgerFlow, StreamThatIsHeldTakesItsSubmissionsInTurn) {
    Script s;
    s.submit(kEngine, kQueue);
    s.wait(kQueue, kHost, 1);
    s.write(kEngine, kColour, 1);
    s.submit(kEngine, kQueue);
    s.read(kQueue, kColour, 1);
    s.signal(kGl, kHost, 1);
    s.ledger.finish(End::Closed);
    EXPECT_EQ(tell(s.ledger), "");
}

TEST(LedgerFlow, ThreadInsideAWaitIsSeenByTheWatchdog) {
    Script s;
    s.signal(kQueue, kDone, 4);
    s.waitBegin(kEngine, kDone, 5);
    ASSERT_EQ(s.ledger.blocked().size(), 1U);
    EXPECT_EQ(s.ledger.blocked()[0].actor, kEngine);
    EXPECT_EQ(s.ledger.blocked()[0].sync, kDone);
    EXPECT_EQ(s.ledger.blocked()[0].value, 5U);
    EXPECT_EQ(s.ledger.blocked()[0].since_ns, 2000U);
    EXPECT_THAT(s.ledger.waitChain(kEngine),
                ElementsAre("engine waits for renderer-to-host >= 5, which has reached 4; queue, who signalled it "
                            "before, has not signalled that yet"));
    s.event(EventKind::ActorEnd, kQueue);
    EXPECT_THAT(s.ledger.waitChain(kEngine), ElementsAre(HasSubstr("queue, who signalled it before, has ended")));
    s.ledger.finish(End::Truncated);
    EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::WaitUnsatisfiable));
}

TEST(LedgerFlow, OnlyTheCauseOfAJamIsTold) {
    Script s;
    s.wait(kQueue, kHost, 1);  // the cause: nobody signals it
    s.signal(kQueue, kDone, 1);
    s.wait(kQueue2, kDone, 1);
    s.signal(kQueue2, kFence, 0);
    s.waitBegin(kEngine, kFence, 0);
    s.ledger.finish(End::Closed);
    ASSERT_THAT(kinds(s.ledger), ElementsAre(FindingKind::WaitUnsatisfiable)) << tell(s.ledger);
    EXPECT_EQ(s.ledger.findings()[0].second.actor, kQueue);
}

TEST(LedgerFlow, CircleOfThreeIsOneFindingWithItsChain) {
    Script s;
    s.wait(kQueue, kHost, 1);
    s.signal(kQueue, kDone, 1);
    s.wait(kQueue2, kDone, 1);
    s.signal(kQueue2, kFence, 0);
    s.wait(kGl, kFence, 0);
    s.signal(kGl, kHost, 1);
    s.waitBegin(kEngine, kHost, 1);  // a victim
    s.ledger.finish(End::Closed);
    ASSERT_THAT(kinds(s.ledger), ElementsAre(FindingKind::WaitCycle)) << tell(s.ledger);
    EXPECT_EQ(s.ledger.findings()[0].chain.size(), 4U);
}

TEST(LedgerFlow, WatchdogsSignalFreesTheWaiterAndTheRightfulOneMayFollow) {
    Script s;
    s.submit(kEngine, kQueue);
    s.wait(kEngine, kDone, 1);
    s.signal(kBridge, kDone, 1, kForced);
    s.signal(kQueue, kDone, 1);
    s.signal(kQueue, kDone, 2);
    s.ledger.finish(End::Closed);
    EXPECT_EQ(tell(s.ledger), "");
}

TEST(LedgerFlow, ForcedSignalOrdersNothingOfTheRendererThatDied) {
    Script s;
    s.write(kQueue, kColour, 1);
    s.signal(kBridge, kDone, 1, kForced);
    s.wait(kGl, kDone, 1);
    s.read(kGl, kColour, 1);
    EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::ReadAfterWrite));
}

TEST(LedgerFlow, TimelineWaitInheritsLowerSignalsOfOthers) {
    Script s;
    s.write(kGl, kColour, 1);
    s.signal(kGl, kHost, 1);
    s.signal(kQueue, kHost, 2);  // in the order of the log, nothing more
    s.wait(kQueue2, kHost, 2);
    s.read(kQueue2, kColour, 1);
    EXPECT_EQ(tell(s.ledger), "");
}

TEST(LedgerFlow, OverWaitIsSeenThroughAHeldStream) {
    Script s;
    s.submit(kEngine, kQueue);
    s.write(kQueue, kColour, 1);
    s.signal(kQueue, kDone, 1);
    s.wait(kQueue2, kHost, 1);
    s.wait(kEngine, kDone, 1, 3 * kMs);
    s.submit(kEngine, kQueue2);
    s.read(kQueue2, kColour, 1);
    s.signal(kGl, kHost, 1);
    s.ledger.finish(End::Closed);
    EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::OverWait)) << tell(s.ledger);
}

TEST(LedgerFlow, ImportMayStandBeforeItsExportInTheLog) {
    Script s;
    MemoryFacts facts;
    facts.size = 100;
    s.ledger.memoryFacts(kColour, facts);
    s.event(EventKind::Import, kGl, kColour);
    facts.size = 200;
    s.ledger.memoryFacts(kColour, facts);
    s.event(EventKind::Export, kQueue, kColour);
    EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::ImportSize)) << tell(s.ledger);
}

TEST(LedgerFlow, NumbersUsedAgainAreNewObjects) {
    Script s;
    for (int i = 0; i < 3; ++i) {
        s.ledger.declareSync(kFence, SyncKind::Fence, "fence", 0, 0);
        s.ledger.declareResource(kColour, "colour", 0, kNoActor);
        s.write(kGl, kColour, 1);
        s.signal(kGl, kFence, 0);
        s.wait(kBridge, kFence, 0);
        s.read(kBridge, kColour, 1);
        s.destroy(kBridge, ObjectClass::Sync, kFence);
        s.destroy(kBridge, ObjectClass::Resource, kColour);
    }
    s.ledger.finish(End::Closed);
    EXPECT_EQ(tell(s.ledger), "");
}

TEST(LedgerFlow, HeldEventsMeanTheObjectOfTheirTime) {
    Script s;
    s.wait(kQueue, kHost, 1);
    s.read(kQueue, kColour, 1);
    s.signal(kGl, kFence, 0);
    s.ledger.declareResource(kColour, "colour, second", 0, kNoActor);
    s.write(kGl, kColour, 1);
    s.signal(kGl, kHost, 1);
    s.write(kEngine, kDepth, 1);
    EXPECT_EQ(tell(s.ledger), "");
}

TEST(LedgerFlow, UndeclaredAndAbsurdNumbersAreNamedOnTheSpot) {
    Ledger ledger;
    Event event;
    event.kind = EventKind::Write;
    event.actor = 3;
    event.object = 0xFFFFFFF0;
    ledger.record(event);
    event.actor = 0xFFFF;
    ledger.record(event);
    EXPECT_EQ(ledger.actorName(3), "actor 3");
    EXPECT_EQ(ledger.syncName(5), "sync 5");
    EXPECT_EQ(ledger.resourceName(0xFFFFFFF0), "resource 4294967280");
    EXPECT_THAT(kinds(ledger), ElementsAre(FindingKind::WriteAfterWrite));
    EXPECT_LT(ledger.memoryBytes(), 100'000U);
}

/// One frame of a ring: engine thread, GL stream, renderer's queue, bridge thread in between.
void ringFrame(Script& s, std::uint64_t k) {
    const auto colour = static_cast<ObjectId>(k % 3), fluid = static_cast<ObjectId>(8 + k % 3);
    s.submit(kEngine, kGl);
    s.write(kGl, colour, k);
    s.signal(kGl, kHost, 2 * k - 1);
    s.submit(kEngine, kQueue);
    s.wait(kQueue, kHost, 2 * k - 1);
    s.read(kQueue, colour, k);
    s.write(kQueue, fluid, k);
    s.signal(kQueue, kDone, k);
    s.wait(kGl, kDone, k);
    s.read(kGl, fluid, k);
    s.signal(kGl, kHost, 2 * k);
}

TEST(LedgerFlow, AMillionHandOffsAreCleanInBoundedMemory) {
    Script s;
    constexpr std::uint64_t kFrames = 500'000;  // two hand-offs each
    std::size_t early = 0;
    const auto begin = std::chrono::steady_clock::now();
    for (std::uint64_t k = 1; k <= kFrames; ++k) {
        ringFrame(s, k);
        early = k == 1000 ? s.ledger.memoryBytes() : early;
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    EXPECT_LE(s.ledger.memoryBytes(), 2 * early);
    EXPECT_LT(s.ledger.memoryBytes(), 1'000'000U);
    const double rate = static_cast<double>(s.ledger.eventsSeen()) / time.count();
    std::printf("%.0f events per second, %zu bytes held\n", rate, s.ledger.memoryBytes());
    s.read(kBridge, 0, kFrames);  // and a fault at the end is still seen
    s.ledger.finish(End::Closed);
    EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::ReadAfterWrite)) << tell(s.ledger);
}

TEST(LedgerFlow, AnOldWaitAfterManyHandOffsOrdersNoMoreThanItsSignal) {
    for (const std::size_t prune_above : {std::size_t{2}, std::size_t{64}, SIZE_MAX}) {
        LedgerOptions options;
        options.prune_above = prune_above;
        Script s(options);
        s.write(kGl, 21, 1);
        for (std::uint64_t k = 1; k <= 1000; ++k) {
            ringFrame(s, k);
            if (k == 450) {
                s.read(kGl, 22);
            }
            if (k == 500) {
                s.write(kGl, 20, 7);
            }
        }
        s.wait(kBridge, kHost, 900);  // of frame 450, given before that read
        s.write(kBridge, 22, 1);
        s.read(kBridge, 21, 1);
        s.wait(kEngine, kHost, 1000);  // of frame 500, given before that write
        s.read(kEngine, 21, 1);
        s.read(kEngine, 20, 7);
        s.ledger.finish(End::Closed);
        ASSERT_THAT(kinds(s.ledger), ElementsAre(FindingKind::WriteAfterRead, FindingKind::ReadAfterWrite))
            << prune_above << tell(s.ledger);
        EXPECT_EQ(s.ledger.findings()[1].second.object, 20U);
    }
}

}  // namespace
}  // namespace sluice::ledger::test
