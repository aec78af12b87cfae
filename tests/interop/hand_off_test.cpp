// SPDX-License-Identifier: MIT
// docs/protocol.md as a specification: legal schedules pass, every single deviation is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "sluice/timeline.hpp"

namespace {

using sluice::compositeRead;
using sluice::fluidWritten;
using sluice::gbufferWritten;
using sluice::HandOff;
using sluice::Holder;
using sluice::imageSetOf;
using sluice::Status;
using ::testing::HasSubstr;

TEST(TimelineValues, AreThoseOfTheTable) {
    static_assert(gbufferWritten(1) == 1 && compositeRead(1) == 2 && fluidWritten(1) == 1);
    for (std::uint64_t frame = 1; frame < 100; ++frame) {
        EXPECT_EQ(gbufferWritten(frame), 2 * frame - 1);
        EXPECT_EQ(compositeRead(frame), gbufferWritten(frame) + 1);
        EXPECT_LT(compositeRead(frame), gbufferWritten(frame + 1)) << "one wait must imply the earlier composite";
        EXPECT_EQ(imageSetOf(frame, 1), 0U);
        EXPECT_EQ(imageSetOf(frame, 3), (frame - 1) % 3);
    }
}

TEST(HandOff, HolderFollowsTheTable) {
    HandOff set(0, 2);
    EXPECT_EQ(set.holder(), Holder::Host);
    ASSERT_TRUE(set.hostAcquire(1, 0).ok());
    EXPECT_EQ(set.holder(), Holder::Host);
    ASSERT_TRUE(set.hostRelease(1).ok());
    EXPECT_EQ(set.holder(), Holder::InFlightToRenderer);
    ASSERT_TRUE(set.rendererAcquire(1, 1).ok());
    EXPECT_EQ(set.holder(), Holder::Renderer);
    ASSERT_TRUE(set.rendererRelease(1).ok());
    EXPECT_EQ(set.holder(), Holder::InFlightToHost);
    ASSERT_TRUE(set.hostCompositeBegin(1, 1).ok());
    EXPECT_EQ(set.holder(), Holder::Host);
    ASSERT_TRUE(set.hostCompositeEnd(1).ok());
    EXPECT_EQ(set.holder(), Holder::Host);
    EXPECT_TRUE(set.hostAcquire(3, 1).ok());
}

TEST(HandOff, ErrorNamesSetFrameValuesAndRemedy) {
    HandOff set(0, 2);
    ASSERT_TRUE(set.hostAcquire(3, 1).ok());
    ASSERT_TRUE(set.hostRelease(3).ok());
    const Status status = set.rendererAcquire(3, 4);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(status.error().message(), HasSubstr("image set 0, renderer acquire of frame 3"));
    EXPECT_THAT(status.error().message(), HasSubstr("must have reached 5, found 4"));
    EXPECT_THAT(status.error().message(), HasSubstr("docs/protocol.md"));
}

TEST(HandOff, AFailedSubmitGivesTheSetBackAndNobodyWaitsForItsValue) {
    HandOff set(0, 1);
    ASSERT_TRUE(set.hostAcquire(1, 0).ok());
    ASSERT_TRUE(set.hostRelease(1).ok());
    set.abandon(1);  // submit_frame(1) failed: value 1 is not signalled
    EXPECT_EQ(set.holder(), Holder::Host);
    EXPECT_FALSE(set.rendererAcquire(1, 1).ok());
    EXPECT_FALSE(set.hostAcquire(1, 0).ok()) << "frames only increase";
    // Were the renderer's value 1 needed here, a ring of one set would never run again.
    EXPECT_TRUE(set.hostAcquire(2, 0).ok());
}

TEST(HandOff, AWaitThatTimedOutIsSatisfiedByALaterFrame) {
    HandOff set(0, 2);
    ASSERT_TRUE(set.hostAcquire(1, 0).ok());
    ASSERT_TRUE(set.hostRelease(1).ok());
    ASSERT_TRUE(set.rendererAcquire(1, 1).ok());
    ASSERT_TRUE(set.rendererRelease(1).ok());
    // The host waited in vain for 1 and composed without fluid. The queue may still write the set.
    EXPECT_FALSE(set.hostAcquire(3, 0).ok());
    EXPECT_EQ(set.holder(), Holder::InFlightToHost);
    EXPECT_TRUE(set.hostAcquire(3, 2).ok()) << "frame 2 of the other set signalled 2 >= 1";
}

TEST(HandOff, AbandonAfterTheReleaseKeepsThePromisedValueOwed) {
    HandOff set(0, 2);
    ASSERT_TRUE(set.hostAcquire(1, 0).ok());
    ASSERT_TRUE(set.hostRelease(1).ok());
    ASSERT_TRUE(set.rendererAcquire(1, 1).ok());
    ASSERT_TRUE(set.rendererRelease(1).ok());
    set.abandon(1);
    EXPECT_FALSE(set.hostAcquire(3, 0).ok());
    EXPECT_TRUE(set.hostAcquire(3, 1).ok());
}

TEST(HandOff, AbandoningASkippedFrameUsesItsNumberUp) {
    HandOff set(1, 2);
    set.abandon(2);
    EXPECT_FALSE(set.hostAcquire(2, 2).ok());
    EXPECT_TRUE(set.hostAcquire(4, 0).ok());
}

TEST(HandOff, AbandoningAnotherSetsOrAnOldFrameChangesNothing) {
    HandOff set(0, 2);
    ASSERT_TRUE(set.hostAcquire(3, 0).ok());
    ASSERT_TRUE(set.hostRelease(3).ok());
    for (const std::uint64_t frame : {0U, 1U, 2U, 4U, 5U}) {
        set.abandon(frame);
        EXPECT_EQ(set.holder(), Holder::InFlightToRenderer) << frame;
    }
}

/// The whole ring with its two counters, as far as the protocol sees it.
struct Ring {
    explicit Ring(std::uint32_t count) : sets(count) {
        for (std::uint32_t i = 0; i < count; ++i) {
            hand_offs.emplace_back(i, count);
        }
    }
    HandOff& of(std::uint64_t frame) { return hand_offs[imageSetOf(frame, sets)]; }

    std::uint32_t sets;
    std::vector<HandOff> hand_offs;
    std::uint64_t host = 0, renderer = 0;
};

enum class Fate { Composited, TimedOut, SubmitFailed, Skipped };

// The host runs ahead by up to `depth` frames before it composites, as far as the ring allows.
RC_GTEST_PROP(HandOffProperty, LegalSchedulesOfAnyRingReportNoError, ()) {
    const auto sets = *rc::gen::inRange<std::uint32_t>(1, SLUICE_MAX_IMAGE_SETS + 1);
    const auto frames = *rc::gen::inRange<std::uint64_t>(1, 60);
    const auto depth = *rc::gen::inRange<std::uint64_t>(0, sets);
    Ring ring(sets);
    std::vector<Fate> fates(frames + 1, Fate::Composited);
    const auto finish = [&](std::uint64_t k) {
        const Fate fate = fates[k];
        HandOff& set = ring.of(k);
        if (fate == Fate::Composited || fate == Fate::TimedOut) {
            ring.renderer = std::max(ring.renderer, fluidWritten(k));
        }
        if (fate == Fate::Composited) {
            RC_ASSERT(set.hostCompositeBegin(k, ring.renderer).ok());
            RC_ASSERT(set.hostCompositeEnd(k).ok());
            ring.host = compositeRead(k);
        }
    };
    for (std::uint64_t k = 1; k <= frames; ++k) {
        fates[k] = *rc::gen::weightedElement<Fate>(
            {{6, Fate::Composited}, {1, Fate::TimedOut}, {1, Fate::SubmitFailed}, {1, Fate::Skipped}});
        HandOff& set = ring.of(k);
        if (fates[k] == Fate::Skipped) {
            set.abandon(k);
        } else {
            RC_ASSERT(set.hostAcquire(k, ring.renderer).ok());
            RC_ASSERT(set.hostRelease(k).ok());
            ring.host = std::max(ring.host, gbufferWritten(k));
            if (fates[k] == Fate::SubmitFailed) {
                set.abandon(k);
            } else {
                RC_ASSERT(set.rendererAcquire(k, ring.host).ok());
                RC_ASSERT(set.rendererRelease(k).ok());
            }
        }
        if (k > depth) {
            finish(k - depth);
        }
    }
}

/// One call of the protocol, and what it needs. `step` numbers the six calls of a frame.
struct Call {
    std::size_t step;
    std::uint64_t frame;
    std::uint64_t counter;  ///< the other side's counter, where the call takes one
};

Status apply(HandOff& set, const Call& call) {
    const std::array<std::function<Status()>, 6> calls{
        [&] { return set.hostAcquire(call.frame, call.counter); },
        [&] { return set.hostRelease(call.frame); },
        [&] { return set.rendererAcquire(call.frame, call.counter); },
        [&] { return set.rendererRelease(call.frame); },
        [&] { return set.hostCompositeBegin(call.frame, call.counter); },
        [&] { return set.hostCompositeEnd(call.frame); },
    };
    return calls[call.step]();
}

Call legal(std::size_t step, std::uint64_t frame, std::uint32_t sets) {
    const std::uint64_t before = frame > sets ? fluidWritten(frame - sets) : 0;
    constexpr std::uint64_t kNone = 0;
    const std::array<std::uint64_t, 6> counters{before, kNone, gbufferWritten(frame), kNone, fluidWritten(frame),
                                                kNone};
    return {step, frame, counters[step]};
}

/// Runs `set` up to, not including, `step` of its frame number `round` (from 0).
HandOff advanced(std::uint32_t index, std::uint32_t sets, std::uint64_t round, std::size_t step) {
    HandOff set(index, sets);
    for (std::uint64_t r = 0; r <= round; ++r) {
        for (std::size_t s = 0; s < (r == round ? step : 6); ++s) {
            EXPECT_TRUE(apply(set, legal(s, r * sets + index + 1, sets)).ok());
        }
    }
    return set;
}

/// Visits every state of the first rounds of every set of every ring.
template <typename Visit>
void everyState(Visit&& visit) {
    for (std::uint32_t sets = 1; sets <= SLUICE_MAX_IMAGE_SETS; ++sets) {
        for (std::uint32_t index = 0; index < sets; ++index) {
            for (std::uint64_t round = 0; round < 3; ++round) {
                for (std::size_t step = 0; step < 6; ++step) {
                    SCOPED_TRACE(testing::Message()
                                 << "set " << index << " of " << sets << ", round " << round << ", step " << step);
                    visit(sets, index, round, step);
                }
            }
        }
    }
}

TEST(HandOffExhaustive, EveryCallOutOfOrderIsRefused) {
    everyState([](std::uint32_t sets, std::uint32_t index, std::uint64_t round, std::size_t step) {
        const std::uint64_t frame = round * sets + index + 1;
        for (std::size_t other = 0; other < 6; ++other) {
            HandOff set = advanced(index, sets, round, step);
            const Holder before = set.holder();
            const Status status = apply(set, legal(other, frame, sets));
            EXPECT_EQ(status.ok(), other == step) << "call " << other;
            if (!status.ok()) {
                EXPECT_EQ(set.holder(), before) << "a refused call must change nothing";
                EXPECT_TRUE(apply(set, legal(step, frame, sets)).ok()) << "the legal call must still work";
            }
        }
    });
}

TEST(HandOffExhaustive, EveryOtherFrameNumberIsRefused) {
    everyState([](std::uint32_t sets, std::uint32_t index, std::uint64_t round, std::size_t step) {
        const std::uint64_t frame = round * sets + index + 1;
        for (std::uint64_t other = 0; other < frame + 2 * sets; ++other) {
            // A later frame of the same set is legal at the acquire: frames may be skipped.
            const bool later = step == 0 && other > frame && imageSetOf(other, sets) == index;
            if (other == frame || later) {
                continue;
            }
            HandOff set = advanced(index, sets, round, step);
            Call call = legal(step, frame, sets);
            call.frame = other;
            call.counter += 100;  // so that only the frame number can be what is refused
            EXPECT_FALSE(apply(set, call).ok()) << "frame " << other;
        }
    });
}

TEST(HandOffExhaustive, EveryCounterThatIsTooLowIsRefusedWhereTheSetIsOwed) {
    everyState([](std::uint32_t sets, std::uint32_t index, std::uint64_t round, std::size_t step) {
        const std::uint64_t frame = round * sets + index + 1;
        const Call call = legal(step, frame, sets);
        for (std::uint64_t counter = 0; counter < call.counter; ++counter) {
            HandOff set = advanced(index, sets, round, step);
            Call low = call;
            low.counter = counter;
            EXPECT_FALSE(apply(set, low).ok()) << "counter " << counter;
            EXPECT_TRUE(apply(set, call).ok());
        }
    });
}

}  // namespace
