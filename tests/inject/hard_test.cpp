// SPDX-License-Identifier: MIT
// Programs that are hard to stand beside: they kill the renderer, destroy what is in use, stand in front of the same
// functions, and share libraries with us.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <set>
#include <sstream>

#include "display.hpp"

namespace sluice::inject::test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

/// Without a window, and so without a server.
class HardInjectTest : public InjectTest {
  protected:
    void SetUp() override {
        makeFolder();
        write("tiny.json", R"({"water": {"radius": 0.1, "low": [-0.6, 0, -0.4], "high": [0.6, 1.2, 0.4]}})");
    }
    Outcome bareHard(const std::string& words) const { return run("'" SLUICE_HARD_TARGET "' " + words); }
    Outcome injectedHard(const std::string& options, const std::string& words) const {
        return run("'" SLUICE_PROGRAM "' inject " + options + " -- '" SLUICE_HARD_TARGET "' " + words);
    }
    Outcome withFluid(const std::string& words) const {
        return injectedHard("--profile tiny.json --step 0.02 --report", words);
    }
};

std::map<int, std::string> framesOf(const std::string& out) {
    std::map<int, std::string> found;
    std::istringstream lines(out);
    for (std::string line; std::getline(lines, line);) {
        int frame = 0;
        unsigned long long hash = 0;
        if (std::sscanf(line.c_str(), "%d %16llx", &frame, &hash) == 2) {
            found[frame] = line;
        }
    }
    return found;
}

/// The frames in which `with` shows what `alone` does not.
std::set<int> changedFrames(const Outcome& alone, const Outcome& with) {
    const std::map<int, std::string> before = framesOf(alone.out);
    const std::map<int, std::string> after = framesOf(with.out);
    EXPECT_EQ(before.size(), after.size()) << with.out << with.err;
    std::set<int> changed;
    for (const auto& [frame, line] : before) {
        if (const auto found = after.find(frame); found != after.end() && found->second != line) {
            changed.insert(frame);
        }
    }
    return changed;
}

TEST_F(HardInjectTest, TheRendererIsKilledTheFramesGoOnAndTheFluidComesBack) {
    const Outcome alone = bareHard("frames=7");
    const Outcome with = withFluid("frames=7 kill=2");
    EXPECT_EQ(with.code, 0) << with.err;
    const std::set<int> changed = changedFrames(alone, with);
    EXPECT_EQ(changed.count(1) + changed.count(2), 2U) << "before it: " << with.out;
    EXPECT_EQ(changed.count(5) + changed.count(6), 2U) << "and again: " << with.out << with.err;
    EXPECT_THAT(with.out, HasSubstr("2 renderer(s)"));
    // How it ended, and what follows; nobody repeats it frame by frame.
    EXPECT_THAT(with.err, ContainsRegex("renderer process [0-9]+"));
    EXPECT_THAT(with.err, HasSubstr("until then the host's frames go on without fluid"));
    EXPECT_LE(std::count(with.err.begin(), with.err.end(), '\n'), 3) << with.err;
}

TEST_F(HardInjectTest, SwapsWithFluidLeakNothingHereAndNothingInTheRenderer) {
    const Outcome with = withFluid("quiet size=16x16 frames=60");
    std::array<long, 4> grown{-1, -1, -1, -1};
    ASSERT_EQ(std::sscanf(with.out.c_str(), "descriptors %ld kib %ld renderer: descriptors %ld kib %ld", &grown[0],
                          &grown[1], &grown[2], &grown[3]),
              4)
        << with.out << with.err;
    EXPECT_EQ(grown[0], 0);
    EXPECT_EQ(grown[2], 0);
    EXPECT_THAT(with.out, HasSubstr("fluid      59 frames, 0 without"));
}

TEST_F(HardInjectTest, WhatChangesUnseenIsAskedFor) {
    const auto watched = [this](const std::string& words) { return injectedHard("--off --report", words).out; };
    EXPECT_THAT(watched("attributes"), HasSubstr("fluid before it in 4 of 6 frames")) << "the matrix mode came back";
    EXPECT_THAT(watched("frames=40 pushes quiet"), HasSubstr("lowest model-view matrix on the stack; confidence 0.90"));
    EXPECT_THAT(watched("framebuffer"), HasSubstr("near 1, far 50")) << "deleted, it is bound no more";
}

TEST_F(HardInjectTest, AContextIsDestroyedWhileAnotherThreadDrawsInIt) {
    const Outcome alone = bareHard("thread frames=8");
    const Outcome with = withFluid("thread frames=8");
    EXPECT_EQ(with.code, 0) << with.err;
    EXPECT_EQ(with.err, "");
    EXPECT_EQ(changedFrames(alone, with), (std::set<int>{1, 2, 3, 4, 5, 6, 7})) << "it lives until it is let go of";
    EXPECT_THAT(with.out, AllOf(HasSubstr("destroyed by the program"), HasSubstr("fluid      7 frames, 0 without")));
    EXPECT_THAT(with.out, Not(HasSubstr("context 2"))) << "the context of before, and no other";
}

TEST_F(HardInjectTest, ADisplayIsTerminatedWithAllThatIsInIt) {
    const Outcome alone = bareHard("terminate frames=8");
    const Outcome with = withFluid("terminate frames=8");
    EXPECT_EQ(with.code, 0) << with.err;
    EXPECT_EQ(with.err, "");
    EXPECT_EQ(changedFrames(alone, with), (std::set<int>{1, 2, 3, 5, 6, 7}));
    EXPECT_THAT(with.out, AllOf(HasSubstr("destroyed by the program"), HasSubstr("context 2")));
}

TEST_F(HardInjectTest, OthersThatStandInFrontOfTheSameFunctionsAreNotRunInCircles) {
    const std::string wrapped = "'" SLUICE_WRAPPED_TARGET "' quiet frames=4";
    const std::string inject = "'" SLUICE_PROGRAM "' inject --off --report -- ";
    for (const std::string& words :
         {"env WRAPPER=next " + inject + wrapped, "env WRAPPER=handle " + inject + wrapped,
          "env WRAPPER=next " + inject + wrapped + " default",
          "env WRAPPER=handle LD_PRELOAD='" SLUICE_WRAPPER "' " + inject + "'" SLUICE_HARD_TARGET "' quiet frames=4",
          "env WRAPPER=next LD_PRELOAD='" SLUICE_WRAPPER "' " + inject + "'" SLUICE_HARD_TARGET "' quiet frames=4"}) {
        const Outcome outcome = run("timeout 20 " + words);
        EXPECT_EQ(outcome.code, 0) << words << outcome.err;
        EXPECT_THAT(outcome.out, HasSubstr("wrapped 4\n")) << words;
        EXPECT_THAT(outcome.out, HasSubstr("frames     4 by eglSwapBuffers 4")) << words;
    }
}

TEST_F(HardInjectTest, WhatTheProgramCallsThroughALibraryThatItSharesWithUsIsSeen) {
    EXPECT_THAT(withFluid("epoxy").out, ContainsRegex("glBindFramebuffer +3 "));
}

}  // namespace
}  // namespace sluice::inject::test
