// SPDX-License-Identifier: MIT
// What counts as success, and when a signal counts as lost.
#include <gtest/gtest.h>

#include "stress/loss.hpp"
#include "stress/verdict.hpp"

namespace sluice::stress::test {
namespace {

Seen seen(Fault fault, std::uint64_t bad_texels, std::uint64_t findings, std::uint64_t refused = 0) {
    return {fault, fault != Fault::None, bad_texels, findings, refused};
}

TEST(Verdict, OfACleanEpochIsBrokenByEitherWitness) {
    for (const Fault fault : {Fault::None, Fault::Delay}) {
        EXPECT_FALSE(whyFailed(seen(fault, 0, 0)));
        EXPECT_TRUE(whyFailed(seen(fault, 1, 0)));
        EXPECT_TRUE(whyFailed(seen(fault, 0, 1)));
        EXPECT_TRUE(whyFailed(seen(fault, 1, 1)));
    }
}

TEST(Verdict, OfARaceNeedsOneWitness) {
    for (const Fault fault : {Fault::SkipWait, Fault::WrongValue, Fault::EarlyReuse}) {
        EXPECT_TRUE(whyFailed(seen(fault, 0, 0)));
        EXPECT_FALSE(whyFailed(seen(fault, 1, 0)));
        EXPECT_FALSE(whyFailed(seen(fault, 0, 1)));
        EXPECT_FALSE(whyFailed({fault, false, 0, 0, 0}));  // interrupted before its round
    }
}

TEST(Verdict, OfADropNeedsTheContentsRight) {
    EXPECT_FALSE(whyFailed(seen(Fault::Drop, 0, 1)));
    EXPECT_TRUE(whyFailed(seen(Fault::Drop, 7, 1)));
    EXPECT_TRUE(whyFailed(seen(Fault::Drop, 0, 0)));
    EXPECT_TRUE(whyFailed({Fault::Drop, false, 7, 0, 0}));
}

TEST(Verdict, OfADuplicateNeedsTheGuardAndTheContentsRight) {
    EXPECT_FALSE(whyFailed(seen(Fault::Duplicate, 0, 1, 1)));
    EXPECT_TRUE(whyFailed(seen(Fault::Duplicate, 0, 1, 0)));
    EXPECT_TRUE(whyFailed(seen(Fault::Duplicate, 0, 1, 2)));
    EXPECT_TRUE(whyFailed(seen(Fault::Duplicate, 7, 1, 1)));
    EXPECT_FALSE(whyFailed({Fault::Duplicate, false, 0, 0, 0}));
}

TEST(Loss, IsOnlyOfWhatWasDroppedAndNotYetGiven) {
    EXPECT_FALSE(signalLost({40, 40, 0, 0, 0}));     // slow is not lost
    EXPECT_FALSE(signalLost({40, 40, 50, 0, 0}));    // planned is not dropped
    EXPECT_TRUE(signalLost({50, 50, 50, 50, 0}));    //
    EXPECT_FALSE(signalLost({60, 60, 50, 50, 50}));  // the watchdog was there
    EXPECT_TRUE(signalLost({90, 90, 90, 90, 50}));   // another one
}

TEST(Loss, WaitsForSignalsThatAreStillUnderWay) {
    // The first of a ring's three is dropped; the watchdog would put the third ahead of what OpenGL still draws.
    EXPECT_FALSE(signalLost({30, 10, 30, 10, 0}));
    EXPECT_FALSE(signalLost({30, 20, 30, 20, 0}));
    EXPECT_TRUE(signalLost({30, 30, 30, 30, 0}));
}

TEST(Loss, IsLookedForFromTheDropToTheRescue) {
    EXPECT_FALSE(dropUnderWay({40, 40, 0, 0, 0}));
    EXPECT_TRUE(dropUnderWay({50, 40, 50, 0, 0}));
    EXPECT_TRUE(dropUnderWay({50, 50, 50, 50, 0}));
    EXPECT_FALSE(dropUnderWay({50, 50, 50, 50, 50}));
}

}  // namespace
}  // namespace sluice::stress::test
