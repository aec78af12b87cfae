// SPDX-License-Identifier: MIT
// render --isolate: the same pictures, and what the user sees when the other process dies.
#include <gmock/gmock.h>

#include "program.hpp"

namespace sluice::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count(const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
        ++found;
    }
    return found;
}

class IsolateOption : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        writeParticles("p.pos", 6);
        writeScene("s.json", "p.pos", R"(, "camera": {"orbit_degrees_per_frame": 5}, "frames": [1, 3])");
    }
};

TEST_F(IsolateOption, PicturesAreThoseOfOneProcessToTheLastBit) {
    ASSERT_EQ(run("render s.json -o one_####.png --layers one_####.exr").code, 0);
    const Outcome outcome =
        run("render s.json -o two_####.png --layers two_####.exr --isolate --ledger --trace t.json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    ASSERT_TRUE(exists("two_0003.exr"));
    for (const char* number : {"1", "2", "3"}) {
        EXPECT_TRUE(read(std::string("one_000") + number + ".png") == read(std::string("two_000") + number + ".png"));
        EXPECT_TRUE(read(std::string("one_000") + number + ".exr") == read(std::string("two_000") + number + ".exr"));
    }
    EXPECT_THAT(outcome.out, HasSubstr("CPU copies of shared images in the frame loop: 0 bytes"));
    EXPECT_THAT(outcome.out, HasSubstr(" events, no finding\n"));
    EXPECT_THAT(read("t.json"), HasSubstr("splat_depth"));
}

TEST_F(IsolateOption, ARendererThatDiesCostsOneFrameItsFluidAndIsToldOnce) {
    ASSERT_EQ(run("render s.json -o wet_####.png").code, 0);
    ASSERT_EQ(run("render s.json -o bare_####.png --no-fluid").code, 0);
    const Outcome outcome = run("render s.json -o a_####.png --isolate --fault kill-renderer@2");
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_EQ(count(outcome.err, "was killed by signal 9 (SIGKILL)"), 1U) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("renderer process "));
    EXPECT_EQ(count(outcome.err, "\n"), 2U) << "how it ended, and what the host does: " << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("useless from frame 2 on, created again within 1 frame (try 1 of 5)"));
    ASSERT_TRUE(exists("a_0003.png"));
    EXPECT_FALSE(read("wet_0002.png") == read("bare_0002.png")) << "the comparison below says nothing";
    EXPECT_TRUE(read("a_0001.png") == read("wet_0001.png"));
    EXPECT_TRUE(read("a_0002.png") == read("bare_0002.png")) << "the host's frame without fluid";
    EXPECT_TRUE(read("a_0003.png") == read("wet_0003.png")) << "by the process that took its place";
}

TEST_F(IsolateOption, ARendererThatStopsIsEndedAtTheDeadline) {
    for (const char* fault : {"stop-renderer@2", "hang@2=600000"}) {
        const Outcome outcome = run(std::string("render s.json -o a_####.png --isolate --deadline 2 --fault ") + fault);
        EXPECT_EQ(outcome.code, 3) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr("did not answer submit_frame of frame 2 within 2.000 s and was killed"));
        EXPECT_THAT(outcome.err, Not(HasSubstr("--isolate"))) << "advice that was taken";
        EXPECT_TRUE(exists("a_0003.png"));
    }
}

TEST_F(IsolateOption, AnInterruptDoesNotWaitForTheDeadline) {
    const Outcome outcome = run("render s.json -o a_####.png --isolate --deadline 3600 --fault stop-renderer@1",
                                "timeout --foreground --preserve-status -s INT -k 120 3");
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_FALSE(exists("a_0003.png"));
}

TEST_F(IsolateOption, AFaultOfAProcessNeedsOneAndAFrame) {
    const Outcome here = run("render s.json -o a_####.png --fault kill-renderer@2");
    EXPECT_EQ(here.code, 1);
    EXPECT_THAT(here.err, HasSubstr("which would die with it (give --isolate)"));
    EXPECT_FALSE(exists("a_0001.png"));
    const Outcome never = run("render s.json -o a_####.png --isolate --fault crash-renderer@9");
    EXPECT_EQ(never.code, 0) << never.err;
    EXPECT_THAT(never.err, HasSubstr("frame 9 never came, the last one was 3: nothing was injected"));
    EXPECT_EQ(run("render s.json -o a_####.png --isolate --no-fluid").code, 1);
}

}  // namespace
}  // namespace sluice::test
