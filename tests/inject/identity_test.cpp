// SPDX-License-Identifier: MIT
// An injected program is the program: every pixel, every error, every descriptor; and with fluid, fluid and no more.
#include <gmock/gmock.h>

#include <cstdio>
#include <set>
#include <sstream>
#include <string>

#include "display.hpp"

namespace sluice::inject::test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(InjectTest, WithoutFluidEveryFrameIsTheProgramsOwnByEveryRoute) {
    for (const char* words :
         {"glx symbol", "glx proc resize", "glx dlsym core depth=32", "egl symbol core second", "egl proc", "egl dlsym",
          "glx symbol samples=4", "glx dlsym core ubo", "egl proc es ubo", "egl symbol es", "glx symbol second",
          "glx symbol destroy frames=6", "egl symbol destroy frames=6", "glx symbol minimise frames=6",
          "egl symbol minimise frames=6"}) {
        const Outcome alone = bare(words);
        ASSERT_EQ(alone.code, 0) << words << alone.err;
        const Outcome with = injected("--off", words);
        EXPECT_EQ(with.code, 0) << words << with.err;
        EXPECT_EQ(with.out, alone.out) << words;
        EXPECT_EQ(with.err, "") << words;
    }
}

#ifdef SLUICE_SDL_TARGET
TEST_F(InjectTest, AProgramOfSdlIsTheSameToo) {
    const Outcome alone = run("'" SLUICE_SDL_TARGET "' 4");
    ASSERT_EQ(alone.code, 0) << alone.err;
    const Outcome with = run("'" SLUICE_PROGRAM "' inject --off --report -- '" SLUICE_SDL_TARGET "' 4");
    EXPECT_EQ(with.code, 0);
    EXPECT_THAT(with.out, HasSubstr(alone.out));
    // One swap is one frame, though SDL's ends in GLX's.
    EXPECT_THAT(with.out, HasSubstr("frames     4 by glXSwapBuffers 4"));
}
#endif

TEST_F(InjectTest, TenThousandSwapsLeakNoDescriptorAndNoMemory) {
    const Outcome with = injected("--off", "glx symbol quiet frames=10000");
    int descriptors = -1;
    long kib = -1;
    ASSERT_EQ(std::sscanf(with.out.c_str(), "descriptors %d kib %ld", &descriptors, &kib), 2) << with.out << with.err;
    EXPECT_EQ(descriptors, 0);
    EXPECT_LE(kib, 128);  // 9,000 frames that leaked 16 bytes each would be 140
}

TEST_F(InjectTest, FluidIsInTheFramesAndNoStateIsLeftBehind) {
    for (const char* words : {"glx symbol frames=4", "egl dlsym core frames=4", "glx symbol samples=4 frames=4",
                              "glx symbol core ubo frames=4", "egl proc es ubo frames=4"}) {
        const Outcome alone = bare(words);
        const Outcome with = injected("--report --step 0.02", words);
        EXPECT_EQ(with.code, 0) << with.err;
        EXPECT_THAT(with.out, HasSubstr("fluid      3 frames, 0 without")) << words << with.err;
        // The first swap brings the payload, so that frame has passed.
        EXPECT_THAT(with.out, AnyOf(HasSubstr("compared before and after: no difference"),
                                    HasSubstr("untouched: the fluid is drawn in a context of its own")));
        EXPECT_THAT(with.out, HasSubstr("near 1, far 50;"));
        EXPECT_THAT(with.out, Not(HasSubstr("hand-off 0.000 ms")));
        EXPECT_THAT(with.out, Not(HasSubstr("fluid 0.000 ms")));
        EXPECT_THAT(with.out, HasSubstr("fluid before it in 2 of 4 frames")) << words;
        // The program finds its own GL error where it left it, and other pixels.
        EXPECT_THAT(with.out, HasSubstr("error 500"));
        EXPECT_THAT(with.out, Not(HasSubstr(alone.out)));
    }
}

TEST_F(InjectTest, AnOverlayIsSeenWhateverItIsDrawnWith) {
    for (const char* words :
         {"glx symbol bar=rect", "glx proc bar=rectv", "glx dlsym bar=pixels", "egl symbol bar=bitmap"}) {
        const Outcome alone = bare(words);
        const Outcome with = injected("--off --report", words);
        EXPECT_EQ(with.code, 0) << words << with.err;
        EXPECT_THAT(with.out, HasSubstr(alone.out)) << words;
        EXPECT_THAT(with.out, HasSubstr("overlay    1 changes to it in the last frame, 1 draws without perspective; "
                                        "fluid before it in 2 of 4 frames"))
            << words;
    }
}

TEST_F(InjectTest, AFluidSurvivesResizeOtherContextsAndADestroyedOne) {
    struct Case {
        const char* words;
        std::set<int> without;  // frames that bring the payload, or the first of another context
    };
    for (const auto& [words, without] :
         {Case{"glx symbol resize frames=6", {0}}, Case{"glx symbol second frames=4", {0, 1}},
          Case{"glx symbol minimise frames=6", {0}}, Case{"egl symbol minimise frames=6", {0}},
          Case{"glx symbol destroy frames=6", {0, 4}}, Case{"egl symbol es destroy frames=6", {0, 4, 5}}}) {
        const Outcome alone = bare(words);
        const Outcome with = injected("--report --step 0.02", words);
        EXPECT_EQ(with.code, 0) << words << with.err;
        EXPECT_EQ(with.err, "") << words;
        EXPECT_THAT(with.out, Not(HasSubstr("given up"))) << words;
        EXPECT_THAT(with.out, Not(HasSubstr("DIFFERENCES"))) << words;
        std::istringstream lines(alone.out);
        for (std::string line; std::getline(lines, line);) {
            EXPECT_EQ(with.out.find(line + "\n") != std::string::npos, without.count(std::stoi(line)) != 0)
                << words << ": " << line;
        }
    }
}

TEST_F(InjectTest, WithoutARendererTheProgramGoesOnAndOneLineSaysWhy) {
    const Outcome alone = bare("glx symbol");
    const Outcome with = injected("--plugin /nonexistent.so", "glx symbol");
    EXPECT_EQ(with.code, 0);
    EXPECT_EQ(with.out, alone.out);
    const std::size_t why = with.err.find("/nonexistent.so");
    ASSERT_NE(why, std::string::npos) << with.err;
    EXPECT_EQ(with.err.find("/nonexistent.so", why + 1), std::string::npos) << "told twice: " << with.err;
    EXPECT_THAT(with.err, HasSubstr("sluice inject: no more fluid in this context\n"));
}

TEST_F(InjectTest, WhatCanHaveNoFluidPassesThroughAndOneLineSaysWhy) {
    struct Case {
        const char *words, *said;
    };
    for (const auto& [words, said] :
         {Case{"glx symbol es", "OpenGL ES: it gets no fluid in a context of GLX (run a program of desktop OpenGL)\n"},
          Case{
              "glx symbol core reversed",
              "reversed depth: near 1 lies at window depth 1 and far 50 at 0, which the compositor does not know\n"}}) {
        const Outcome alone = bare(words);
        const Outcome with = injected("", words);
        EXPECT_EQ(with.code, 0) << words;
        EXPECT_EQ(with.out, alone.out) << words;
        EXPECT_EQ(with.err, "sluice inject: no more fluid in this context: " + std::string(said));
    }
}

}  // namespace
}  // namespace sluice::inject::test
