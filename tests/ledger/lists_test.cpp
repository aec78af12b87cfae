// SPDX-License-Identifier: MIT
// Syncs with lists: what becomes visible, and that forgetting signals does not blur it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "script.hpp"

namespace sluice::ledger::test {
namespace {

using testing::ElementsAre;

LedgerOptions forgetful() {
    LedgerOptions options;
    options.prune_above = 2;
    return options;
}

/// Signals that name everything, after which the ledger has looked for some to forget.
void signalOn(Script& s, ActorId by, ObjectId sync, std::uint64_t from) {
    for (std::uint64_t value = from; value < from + 50; ++value) {
        s.signal(by, sync, value);
    }
}

TEST(LedgerLists, LowerSignalsNamesCountForAHigherWait) {
    Script s;
    s.write(kQueue, kColour, 1);
    s.names(kQueue, kColour);
    s.signal(kQueue, kListed, 1);
    s.names(kQueue, kDepth);
    s.signal(kQueue, kListed, 2);
    s.names(kGl, kColour);
    s.wait(kGl, kListed, 2);
    s.read(kGl, kColour, 1);
    EXPECT_EQ(tell(s.ledger), "");
}

TEST(LedgerLists, LowerSignalWithoutAListCountsForAHigherWait) {
    Script s;
    s.write(kQueue, kColour, 1);
    s.signal(kQueue, kListed, 1);
    s.names(kQueue, kDepth);
    s.signal(kQueue, kListed, 2);
    s.names(kGl, kColour);
    s.wait(kGl, kListed, 2);
    s.read(kGl, kColour, 1);
    EXPECT_EQ(tell(s.ledger), "");
}

TEST(LedgerLists, GlContextThatNamesNothingMakesNothingVisible) {
    for (const bool gl_signals : {false, true}) {
        Script s;
        const ActorId from = gl_signals ? kGl : kQueue, to = gl_signals ? kQueue : kGl;
        s.write(from, kColour, 1);
        s.signal(from, kListed, 1);
        s.wait(to, kListed, 1);
        s.read(to, kColour, 1);
        EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::NotListed)) << tell(s.ledger);
    }
}

TEST(LedgerLists, ALaterPlainWaitMakesEverythingVisible) {
    Script s;
    s.write(kQueue, kColour, 1);
    s.signal(kQueue, kListed, 1);
    s.signal(kQueue, kDone, 1);
    s.wait(kGl, kListed, 1);
    s.wait(kGl, kDone, 1);
    s.read(kGl, kColour, 1);
    EXPECT_EQ(tell(s.ledger), "");
}

TEST(LedgerLists, ForgettingKeepsASignalThatNamesLess) {
    for (const bool next_has_list : {false, true}) {
        Script s(forgetful());
        s.write(kQueue, kColour, 1);
        s.names(kQueue, kDepth);
        s.signal(kQueue, kListed, 1);
        if (next_has_list) {
            s.names(kQueue, kColour);
        }
        s.signal(kQueue, kListed, 2);
        signalOn(s, kQueue, kListed, 3);
        s.names(kGl, kColour);
        s.wait(kGl, kListed, 1);
        s.read(kGl, kColour, 1);
        EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::NotListed)) << tell(s.ledger);
    }
}

TEST(LedgerLists, ForgettingKeepsASignalOfOneWhoSawLess) {
    for (const bool sees_by_list : {false, true}) {
        Script s(forgetful());
        s.write(kQueue, kColour, 1);
        s.signal(kQueue, kListed, 1);
        s.signal(kQueue, kDone, 1);
        s.signal(kQueue, kDone, 2);
        s.names(kGl, kDepth);
        s.wait(kGl, kListed, 1);  // ordered after the write, without seeing it
        s.signal(kGl, kHost, 1);
        if (sees_by_list) {
            s.names(kGl, kColour);
            s.wait(kGl, kListed, 1);
        } else {
            s.wait(kGl, kDone, 1);
        }
        signalOn(s, kGl, kHost, 2);
        s.wait(kGl, kDone, 2);  // so that no earlier wait is remembered that would keep the two apart
        signalOn(s, kGl, kHost, 52);
        s.wait(kQueue2, kHost, 1);
        s.read(kQueue2, kColour, 1);
        EXPECT_THAT(kinds(s.ledger), ElementsAre(FindingKind::NotListed)) << sees_by_list << tell(s.ledger);
        s.wait(kBridge, kHost, 2);
        s.read(kBridge, kColour, 1);
        EXPECT_EQ(s.ledger.findings().size(), 1U) << sees_by_list << tell(s.ledger);
    }
}

}  // namespace
}  // namespace sluice::ledger::test
