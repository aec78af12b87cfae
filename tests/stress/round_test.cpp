// SPDX-License-Identifier: MIT
// A round reads what the round before it has written, and its values only ever increase.
#include <gtest/gtest.h>

#include "stress/round.hpp"

namespace sluice::stress::test {
namespace {

using Versions = std::vector<std::uint64_t>;

TEST(Course, PingPongReadsEachSidesLastWord) {
    Course course(Pattern::PingPong, {1, 1, false}, 3);
    const Round first = course.next(0);
    EXPECT_TRUE(first.gl.inputs.empty());  // nothing is there yet
    EXPECT_EQ(first.gl_wait, 0U);
    EXPECT_EQ(first.vulkan.at(0).input_versions, Versions{first.gl.version});
    EXPECT_EQ(first.hands.at(0).wait, first.gl_signal);
    const Round second = course.next(1);
    EXPECT_EQ(second.gl.input_versions, Versions{first.vulkan.at(0).version});
    EXPECT_EQ(second.gl_wait, first.hands.at(0).signal);
    EXPECT_GT(second.gl_signal, first.gl_signal);
    EXPECT_LE(second.gl_signal - first.gl_signal, 10'000U);
}

TEST(Course, ARingComesBackToASetAfterItsOwnValue) {
    Course course(Pattern::Ring, {3, 1, false}, 3);
    std::vector<Round> rounds;
    for (std::uint32_t i = 0; i < 7; ++i) {
        rounds.push_back(course.next(i));
        EXPECT_EQ(rounds.back().set, i % 3);
    }
    EXPECT_EQ(rounds[6].gl_wait, rounds[3].hands.at(0).signal);
    EXPECT_EQ(rounds[2].gl_wait, 0U);
}

TEST(Course, AFanReadsOneImageManyTimesAndComesTogetherAgain) {
    Course course(Pattern::FanOut, {1, 3, false}, 3);
    const Round first = course.next(0);
    ASSERT_EQ(first.vulkan.size(), 3U);
    for (const Turn& turn : first.vulkan) {
        EXPECT_EQ(turn.input_versions, Versions{first.gl.version});
    }
    EXPECT_EQ(first.hands[0].wait, first.hands[2].wait);
    const Round second = course.next(1);
    EXPECT_EQ(second.gl.inputs.size(), 3U);
    EXPECT_EQ(second.gl_wait, first.hands[2].signal);
}

TEST(Course, OneWayPatternsCarryTheChainOnTheReadersSide) {
    Course to_vulkan(Pattern::GlToVk, {1, 1, false}, 3);
    (void)to_vulkan.next(0);
    const Round there = to_vulkan.next(1);
    EXPECT_TRUE(there.gl.inputs.empty());
    EXPECT_NE(there.gl_wait, 0U);  // the permission to write again
    EXPECT_EQ(there.vulkan.at(0).inputs.size(), 2U);
    EXPECT_GE(there.vulkan.at(0).output, to_vulkan.slots().shared());

    Course to_gl(Pattern::VkToGl, {1, 1, false}, 3);
    const Round before = to_gl.next(0);
    const Round back = to_gl.next(1);
    EXPECT_TRUE(back.vulkan.at(0).inputs.empty());
    EXPECT_EQ(back.hands.at(0).wait, before.gl_signal);
    EXPECT_EQ(back.gl_wait, back.hands.at(0).signal);
    EXPECT_EQ(back.gl.inputs.size(), 2U);
}

TEST(Course, AfterARestartNothingOldIsRead) {
    Course course(Pattern::PingPong, {1, 1, false}, 3);
    const Round before = course.next(0);
    EXPECT_EQ(course.takeTurns().size(), 2U);
    course.restart();
    const Round after = course.next(1);
    EXPECT_TRUE(after.gl.inputs.empty());
    EXPECT_EQ(after.gl_wait, before.hands.at(0).signal);  // but the memory is still to be waited for
    course.rebuilt();
    EXPECT_EQ(course.next(2).gl_wait, 0U);
}

}  // namespace
}  // namespace sluice::stress::test
