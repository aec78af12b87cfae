// SPDX-License-Identifier: MIT
// One fault, one finding: repetitions are counted, and what follows from a fault is not told besides.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "script.hpp"

namespace sluice::ledger::test {
namespace {

using testing::ElementsAre;

TEST(LedgerOnce, RepetitionsAreCountedNotListed) {
    Script s;
    for (std::uint64_t k = 1; k <= 100; ++k) {
        s.event(EventKind::Frame, kGl, kNoObject, k);
        s.event(EventKind::Frame, kQueue, kNoObject, k);
        s.write(kGl, kColour, k);
        s.signal(kGl, kHost, k);
        s.read(kQueue, kColour, k);  // its wait was forgotten
        s.signal(kQueue, kDone, k);
        s.wait(kGl, kDone, k);
    }
    s.ledger.finish(End::Closed);
    ASSERT_THAT(kinds(s.ledger), ElementsAre(FindingKind::ReadAfterWrite)) << tell(s.ledger);
    const Finding& finding = s.ledger.findings()[0];
    EXPECT_EQ(finding.count, 100U);
    EXPECT_EQ(finding.frame, 1U);
    EXPECT_EQ(finding.edge, "gl:signal(host-to-renderer, 1) -> queue:wait(host-to-renderer, 1)");
    EXPECT_EQ(
        finding.sentence,
        "queue reads colour in frame 1 (version 1), but nothing orders that after the write of version 1 by gl in "
        "frame 1.");
}

TEST(LedgerOnce, FurtherFindingsAreCounted) {
    LedgerOptions options;
    options.max_findings = 1;
    Script s(options);
    s.write(kGl, kColour, 1);
    s.write(kGl, kDepth, 1);
    s.read(kQueue, kColour);
    s.read(kQueue, kDepth);
    EXPECT_EQ(s.ledger.findings().size(), 1U);
    EXPECT_EQ(s.ledger.findingsDropped(), 1U);
}

TEST(LedgerOnce, ARaceIsNotToldAgainByThoseWhoComeAfterIt) {
    Script s;
    s.write(kGl, kColour, 1);
    s.read(kQueue, kColour, 1);  // the race
    s.signal(kQueue, kDone, 1);
    s.wait(kQueue2, kDone, 1);
    s.read(kQueue2, kColour, 1);  // ordered after the racing read: the same missing edge
    s.read(kEngine, kColour, 1);  // ordered after nothing: another one
    EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::ReadAfterWrite, FindingKind::ReadAfterWrite));
    EXPECT_EQ(s.ledger.findings()[1].second.actor, kEngine);
}

TEST(LedgerOnce, AnUnlistedResourceIsToldToNobodyElse) {
    Script s;
    s.write(kQueue, kColour, 1);
    s.signal(kQueue, kListed, 1);
    s.names(kGl, kDepth);
    s.wait(kGl, kListed, 1);
    s.read(kGl, kColour, 1);
    s.read(kGl, kColour, 1);
    s.signal(kGl, kHost, 1);
    s.wait(kQueue2, kHost, 1);
    s.read(kQueue2, kColour, 1);
    ASSERT_THAT(kinds(s.ledger), ElementsAre(FindingKind::NotListed)) << tell(s.ledger);
    EXPECT_EQ(s.ledger.findings()[0].count, 1U);
}

TEST(LedgerOnce, VictimsOfACircleAreNotItsMembers) {
    Script s;
    s.wait(kQueue, kHost, 1);
    s.signal(kQueue, kDone, 1);
    s.wait(kQueue2, kDone, 1);
    s.signal(kQueue2, kHost, 1);
    s.wait(kGl, kHost, 1);
    s.ledger.finish(End::Closed);
    ASSERT_THAT(kinds(s.ledger), ElementsAre(FindingKind::WaitCycle)) << tell(s.ledger);
    EXPECT_NE(s.ledger.findings()[0].second.actor, kGl);
}

TEST(LedgerOnce, ARaceOnAnOwnedResourceSaysNothingOfOwnersAndLayouts) {
    Script s;
    s.acquire(kQueue, kColour, 1, 2);
    s.write(kQueue, kColour, 1);
    s.release(kQueue, kColour, 2, 5, kQueue2);
    s.acquire(kQueue2, kColour, 1, 1, kGl);  // a race with the release, and all else wrong too
    s.read(kQueue2, kColour, 1);
    s.layout(kQueue2, kColour, 7, 8);
    EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::WriteAfterWrite)) << tell(s.ledger);
}

TEST(LedgerOnce, ARaceWithTheOwnerIsNotOneOfOwnershipBesides) {
    Script s;
    s.acquire(kQueue, kColour, 1, 1);
    s.write(kQueue, kColour, 1);
    s.read(kGl, kColour, 1);
    s.signal(kQueue, kDone, 1);
    s.wait(kGl, kDone, 1);
    s.read(kGl, kColour, 1);
    EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::ReadAfterWrite)) << tell(s.ledger);
}

}  // namespace
}  // namespace sluice::ledger::test
