// SPDX-License-Identifier: MIT
// sluice inject as a command: what passes through it, and what does not.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "display.hpp"

namespace sluice::inject::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kInject = "'" SLUICE_PROGRAM "' inject ";

std::string fileText(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::set<std::string> names(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    std::set<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), expression); at != std::sregex_iterator(); ++at) {
        found.insert((*at)[1]);
    }
    return found;
}

TEST(InjectShim, ExportsItsHooksAndNothingElse) {
    const std::string table = fileText(SLUICE_SHIM_EXPORTS "/shim.h");
    std::set<std::string> hooks = names(table, "X\\([\\s\\\\]*(\\w{3,})\\)");
    EXPECT_GT(hooks.size(), 60U);
    hooks.insert({"dlsym", "dlvsym"});
    EXPECT_EQ(names(fileText(SLUICE_SHIM_EXPORTS "/exports.map"), "\n +(\\w+);"), hooks);
}

TEST_F(InjectTest, ExitCodesAndSignalsPassThroughWithAndWithoutAReport) {
    for (const char* options : {"--off", "--off --report --json"}) {
        EXPECT_EQ(injected(options, "glx symbol frames=1 code=7").code, 7) << options;
        EXPECT_EQ(injected(options, "glx symbol frames=1 raise=11").code, 128 + 11) << options;
        EXPECT_EQ(run(std::string(kInject) + options + " -- sh -c 'kill -TERM $$'").code, 128 + 15) << options;
        EXPECT_EQ(run(std::string(kInject) + options + " -- /nonexistent/program").code, 127) << options;
    }
}

TEST_F(InjectTest, AReportInAFileIsApartFromWhatTheProgramPrints) {
    const Outcome alone = bare("glx symbol");
    const Outcome with = injected("--off --report --json --report-to folder/seen.json", "glx symbol");
    EXPECT_EQ(with.code, 0) << with.err;
    EXPECT_EQ(with.out, alone.out);
    const Outcome report = run("cat folder/seen.json");
    EXPECT_THAT(report.out, AllOf(StartsWith("["), HasSubstr("\"frames\": 4")));
    const Outcome nowhere = injected("--off --report --report-to /proc/none/seen.json", "glx symbol");
    EXPECT_NE(nowhere.code, 0);
    EXPECT_EQ(nowhere.out, "") << "the program has not been started";
    EXPECT_THAT(nowhere.err, HasSubstr("/proc/none"));
}

TEST_F(InjectTest, AProgramThatIsKilledLeavesItsReport) {
    const Outcome outcome = injected("--off --report", "glx symbol frames=3 raise=9");
    EXPECT_EQ(outcome.code, 128 + 9);
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("context 1: GLX, OpenGL"), HasSubstr("glXSwapBuffers"),
                                   HasSubstr("depth 24 bits, stencil 8 bits, 0 samples")));
}

TEST_F(InjectTest, AProcessWithoutOpenGlLoadsNothingMore) {
    const Outcome bare_fds = run("sh -c 'exec ls /proc/self/fd'");
    const Outcome fds = run(std::string(kInject) + "-- ls /proc/self/fd");
    EXPECT_EQ(fds.out, bare_fds.out);
    const Outcome maps = run(std::string(kInject) + "-- cat /proc/self/maps");
    EXPECT_THAT(maps.out, HasSubstr("libsluice_inject.so"));
    for (const char* other : {"libsluice_payload", "libGL", "libEGL", "libX11", "libstdc++"}) {
        EXPECT_THAT(maps.out, Not(HasSubstr(other)));
    }
    const Outcome report = run(std::string(kInject) + "--off --report -- true");
    EXPECT_THAT(report.out, HasSubstr("No frame of OpenGL was seen"));
}

TEST_F(InjectTest, ChildrenAreLeftAloneUnlessAskedFor) {
    const std::string child = "glx symbol frames=2 quiet 'child=env; cat /proc/self/maps'";
    const Outcome alone = injected("--off", child);
    EXPECT_THAT(alone.out,
                AllOf(Not(HasSubstr("LD_PRELOAD")), Not(HasSubstr("SLUICE_INJECT")), Not(HasSubstr("libsluice"))));
    const Outcome all = injected("--off --children", child);
    EXPECT_THAT(all.out, AllOf(HasSubstr("LD_PRELOAD"), HasSubstr("libsluice_inject.so")));
    // What the user preloads himself stays where it was.
    const Outcome mine = run("env LD_PRELOAD=/usr/lib/libnothing.so " + std::string(kInject) + "--off -- sh -c env");
    EXPECT_THAT(mine.out, HasSubstr("LD_PRELOAD=/usr/lib/libnothing.so\n"));
}

TEST_F(InjectTest, AProfileIsReadBeforeTheProgramStarts) {
    write("good.json",
          R"({"program": "x", "camera": {"route": "fixed_function", "near": 0.5, "far": 9}, "overlay": "swap",
        "water": {"place": "world", "units_per_metre": 10, "up": [0, 0, 1],
        "emitters": [{"shape": "disc", "centre": [0, 1, 0], "direction": [0, -1, 0], "width": 0.5, "height": 0.5,
                      "speed": 1}]}})");
    const Outcome good = injected("--off --report --profile good.json", "glx symbol");
    EXPECT_THAT(good.out, AllOf(HasSubstr("near 0.5, far 9;"), HasSubstr("planes by the profile"),
                                HasSubstr("fluid before it in 0 of 4 frames")));
    const auto refused = [this](const std::string& text, const char* said) {
        write("bad.json", text);
        const Outcome outcome = injected("--off --profile bad.json", "glx symbol code=9");
        EXPECT_EQ(outcome.code, 2) << text;
        EXPECT_THAT(outcome.err, HasSubstr(said)) << text;
        EXPECT_THAT(outcome.out, IsEmpty());
    };
    refused("[]", "expected a JSON object, found a JSON array");
    refused("{\"program\": \"x\",\n \"overlay\": \"swap\",}", "line 2, column 20");
    refused(R"({"water": {"emitters": [{"speed": 1}]}})", "/water/emitters/0/shape");
    refused(R"({"camera": {"roote": "uniforms"}})", "route");
    refused(R"({"overlay": "never"})", "/overlay");
    refused(R"({"camera": {"near": 5, "far": 1}})", "/camera/far");
    refused(R"({"water": {"up": [0, 0, 0]}})", "/water/up");
    EXPECT_EQ(injected("--off --profile missing.json", "glx symbol").code, 2);
}

TEST_F(InjectTest, AWrongCommandLineStartsNothing) {
    for (const char* words :
         {"", "--off", "--bogus -- true", "--step 0 -- true", "--json -- true", "--report-to x -- true"}) {
        const Outcome outcome = run(kInject + std::string(words));
        EXPECT_EQ(outcome.code, 1) << words;
        EXPECT_THAT(outcome.err, HasSubstr("sluice: error:")) << words;
    }
}

TEST_F(InjectTest, OfAScriptItIsSaidThatItsChildrenAreLeftAlone) {
    write("start.sh", "#!/bin/sh\nexit 3\n");
    const Outcome outcome = run("sh -c \"chmod +x start.sh; exec " + std::string(kInject) + "--off -- ./start.sh\"");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("--children"));
}

}  // namespace
}  // namespace sluice::inject::test
