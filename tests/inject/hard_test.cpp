// SPDX-License-Identifier: MIT
// Programs that are hard to stand beside: they kill the renderer, destroy what is in use, stand in front of the same
// functions, and share libraries with us.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
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

std::set<std::string> matches(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    std::set<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), expression); at != std::sregex_iterator(); ++at) {
        found.insert((*at)[1]);
    }
    return found;
}

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

TEST_F(HardInjectTest, AFluidThatHasFailedBeginsAgain) {
    // Particles of a millimetre at a hundred metres a second: half a second is more steps than there may be.
    write("wild.json", R"({"water": {"radius": 0.001, "low": [-0.006, 0, -0.004], "high": [0.006, 0.012, 0.004],
        "blocks": [{"low": [-0.006, 0, -0.004], "high": [0, 0.006, 0.004], "velocity": [100, 0, 0]}]}})");
    const Outcome with = injectedHard("--profile wild.json --step 0.5 --report --json", "quiet size=16x16 frames=18");
    EXPECT_EQ(with.code, 0) << with.err;
    EXPECT_THAT(with.err, HasSubstr("sluice inject: the fluid begins again\n"));
    EXPECT_THAT(with.out, AllOf(HasSubstr("\"restarts\": 1"), HasSubstr("\"frames_without\": 0")));
}

TEST_F(HardInjectTest, AProgramThatUsesNoDepthHasNoneInItsWay) {
    const Outcome alone = bareHard("nodepth frames=6");
    const Outcome with = withFluid("nodepth frames=6");
    EXPECT_EQ(with.code, 0) << with.err;
    const std::set<int> changed = changedFrames(alone, with);
    EXPECT_EQ(changed.count(3) + changed.count(4) + changed.count(5), 3U) << with.out << with.err;
    EXPECT_THAT(with.out, HasSubstr("compared before and after: no difference"));
    EXPECT_THAT(with.out, HasSubstr(" units per metre, up is +y\n"));
}

TEST_F(HardInjectTest, ADepthThatIsUsedInTheMiddleOfAFrameOrClearedByNameIsNotWiped) {
    const auto cleared = [this](const std::string& words) {
        const Outcome with = injectedHard("--profile tiny.json --step 0.02 --report --json", words + " size=16x16");
        EXPECT_EQ(with.code, 0) << with.err;
        const std::set<std::string> counts = matches(with.out, R"("unused_depths_cleared": (\d+))");
        return counts.size() == 1 ? std::stoi(*counts.begin()) : -1;
    };
    EXPECT_GE(cleared("nodepth frames=6"), 3);
    EXPECT_EQ(cleared("sky frames=6"), 0);
    EXPECT_EQ(cleared("named frames=6"), 0);
}

TEST_F(HardInjectTest, AFramebufferThatIsMadeAnewAndAMenuBeforeItLeaveTheFluidAsItIs) {
    const auto placements = [this](const std::string& words, const std::string& profile = "tiny.json") {
        const Outcome with =
            injectedHard("--profile " + profile + " --step 0.02 --report --json", words + " size=16x16");
        EXPECT_EQ(with.code, 0) << with.err;
        EXPECT_THAT(with.out, ContainsRegex("\"scene_in_framebuffer\": [1-9]")) << with.err;
        const std::set<std::string> counts = matches(with.out, R"("placements": (\d+))");
        return counts.size() == 1 ? std::stoi(*counts.begin()) : -1;
    };
    EXPECT_EQ(placements("fbo=0 frames=12 anew=4 menu=7"), 1);
    EXPECT_EQ(placements("fbo=3 frames=9"), 2) << "what was in the window was a menu";
    write("world.json", R"({"water": {"place": "world", "radius": 0.1, "low": [-1, 0, -7], "high": [0, 1, -6]}})");
    EXPECT_EQ(placements("fbo=3 frames=9", "world.json"), 1) << "whose place is no matter of the eye";
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
    constexpr const char* kInject = "'" SLUICE_PROGRAM "' inject --off --report -- ";
    constexpr const char* kWrapped = "'" SLUICE_WRAPPED_TARGET "' quiet frames=4";
    constexpr const char* kPreload = "LD_PRELOAD='" SLUICE_WRAPPER "' ";
    constexpr const char* kPlain = "'" SLUICE_HARD_TARGET "' quiet frames=4";
    for (const std::string& words : {fmt::format("env WRAPPER=next {}{}", kInject, kWrapped),
                                     fmt::format("env WRAPPER=handle {}{}", kInject, kWrapped),
                                     fmt::format("env WRAPPER=next {}{} default", kInject, kWrapped),
                                     fmt::format("env WRAPPER=handle {}{}{}", kPreload, kInject, kPlain),
                                     fmt::format("env WRAPPER=next {}{}{}", kPreload, kInject, kPlain)}) {
        const Outcome outcome = run("timeout 20 " + words);
        EXPECT_EQ(outcome.code, 0) << words << outcome.err;
        EXPECT_THAT(outcome.out, HasSubstr("wrapped 4\n")) << words;
        EXPECT_THAT(outcome.out, HasSubstr("frames     4 by eglSwapBuffers 4")) << words;
    }
}

TEST_F(HardInjectTest, WhatTheProgramCallsThroughALibraryThatItSharesWithUsIsSeen) {
    EXPECT_THAT(withFluid("epoxy").out, ContainsRegex("glBindFramebuffer +3 "));
}

TEST_F(HardInjectTest, TheProgramHasNoChildOfOursAndTakesItsSignalsItself) {
    const Outcome alone = bareHard("frames=3 wait signals");
    const Outcome with = withFluid("frames=3 wait signals");
    EXPECT_EQ(with.code, 0) << with.err;
    EXPECT_THAT(with.out, HasSubstr("fluid      2 frames, 0 without"));
    // Those that take signals are the program's and its driver's own, and so is the one child.
    const std::size_t threads = alone.out.find("threads open to signals");
    ASSERT_NE(threads, std::string::npos) << alone.out;
    EXPECT_THAT(alone.out, HasSubstr("children 1 signals 1\n"));
    EXPECT_THAT(with.out, HasSubstr(alone.out.substr(threads)));
}

TEST_F(HardInjectTest, TheRendererEndsWithAProgramThatIsKilled) {
    const Outcome with = withFluid("frames=3 die");
    EXPECT_EQ(with.code, 128 + 9);
    const std::size_t at = with.out.find("renderer ");
    ASSERT_NE(at, std::string::npos) << with.out << with.err;
    const int pid = std::stoi(with.out.substr(at + 9));
    ASSERT_GT(pid, 0);
    const std::string status = fmt::format("/proc/{}/stat", pid);
    bool gone = false;
    for (int tries = 0; tries < 600 && !gone; ++tries) {
        std::ifstream file(status);
        std::string number;
        std::string name;
        std::string state;
        gone = !(file >> number >> name >> state) || state == "Z" || name != "(sluice-renderer)";
        ::usleep(50'000);
    }
    EXPECT_TRUE(gone) << "process " << pid;
}

TEST_F(HardInjectTest, ARendererThatHangsAtItsStartHoldsNoFrameUp) {
    const Outcome alone = bareHard("frames=8");
    const auto hanging = [this](const char* deadline, const std::string& words) {
        write("slow.json", fmt::format("{{\"start_deadline\": {}}}", deadline));
        return run(fmt::format("timeout 60 '{}' inject --plugin '{}' --profile slow.json -- '{}' {}", SLUICE_PROGRAM,
                               SLUICE_HANGING_PLUGIN, SLUICE_HARD_TARGET, words));
    };
    const Outcome with = hanging("600", "frames=8");
    EXPECT_EQ(with.code, 0);
    EXPECT_EQ(with.out, alone.out);
    EXPECT_EQ(with.err, "");
    const Outcome given_up = hanging("0.2", "frames=60 pace=50 quiet");
    EXPECT_EQ(given_up.code, 0);
    EXPECT_THAT(given_up.err, HasSubstr("sluice inject: no more fluid in this context"));
    EXPECT_THAT(given_up.err, HasSubstr("did not answer its start within 0.200 s"));
}

std::set<std::string> symbolsOf(const std::string& output) {
    std::set<std::string> found;
    std::istringstream lines(output);
    for (std::string address, kind, name; lines >> address >> kind >> name;) {
        if (kind != "A") {  // a version's own
            found.insert(name.substr(0, name.find('@')));
        }
    }
    return found;
}

/// A program's own C++ runtime, fmt or whatever else it has brought must not come between, nor ours before them.
TEST_F(HardInjectTest, LibrariesInOtherProgramsExportWhatTheyMustAndNeedWhatEverybodyHas) {
    struct Case {
        const char* library;
        const char* exports;
        std::set<std::string> needs;
    };
    for (const auto& [library, exports, needs] :
         {Case{SLUICE_SHIM, SLUICE_HOST_GL "/inject/shim/exports.map", {"libc.so.6"}},
          Case{SLUICE_PAYLOAD,
               SLUICE_HOST_GL "/inject/payload/exports.map",
               {"libepoxy.so.0", "libm.so.6", "libc.so.6", "ld-linux-x86-64.so.2"}},
          Case{SLUICE_API_LIBRARY,
               SLUICE_HOST_GL "/src/api/exports.map",
               {"libepoxy.so.0", "libm.so.6", "libc.so.6", "ld-linux-x86-64.so.2"}}}) {
        std::ifstream map(exports);
        const std::string text{std::istreambuf_iterator<char>(map), std::istreambuf_iterator<char>()};
        EXPECT_EQ(symbolsOf(run(fmt::format("nm -D --defined-only '{}'", library)).out), matches(text, "\n +(\\w+);"))
            << library;
        const Outcome needed = run(fmt::format("env LC_ALL=C readelf -d '{}'", library));
        for (const std::string& name : matches(needed.out, "NEEDED.*\\[(.*)\\]")) {
            EXPECT_EQ(needs.count(name), 1U) << library << " needs " << name;
        }
        EXPECT_THAT(needed.out, HasSubstr("libc.so.6"));
        EXPECT_THAT(run(fmt::format("nm -D --undefined-only '{}'", library)).out, Not(HasSubstr(" U _Z"))) << library;
    }
}

}  // namespace
}  // namespace sluice::inject::test
