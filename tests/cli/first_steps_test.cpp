// SPDX-License-Identifier: MIT
// What a person meets who has just built the program: help pages, slips of the keyboard, forgotten radii, the manual.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "program.hpp"

namespace sluice::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

/// Lines of the manual that start with the program's name: the synopsis, whose block has no language, or the commands
/// of the blocks of shell.
std::vector<std::string> manualLines(const std::string& fence) {
    std::ifstream file(std::filesystem::path(SLUICE_SOURCE) / "docs/cli.md");
    std::vector<std::string> lines;
    std::string block;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("```")) {
            block = block.empty() ? line : "";
        } else if (block == fence && line.starts_with("sluice ")) {
            lines.push_back(line);
        }
    }
    return lines;
}

class FirstSteps : public ProgramTest {
  protected:
    void writePlyWithoutRadius(const std::string& name) const {
        write(name,
              "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
              "end_header\n0 0.5 0\n0.1 0.6 0\n");
    }
};

TEST_F(FirstSteps, HelpPagesFitATerminalAndShowNothingOfTheLibraryBeneath) {
    for (const char* command :
         {"", "render", "probe", "explain", "generate", "generate pool", "convert", "simulate", "stress"}) {
        const Outcome help = run(std::string(command) + " --help");
        EXPECT_EQ(help.code, 0);
        EXPECT_THAT(help.out, HasSubstr("Usage: sluice" + std::string(*command == 0 ? "" : " ") + command + " "));
        for (const char* leak :
             {"TEXT", "UINT", "FLOAT", "POSITIVE", "REQUIRED", "Excludes", "->", "{", " OR ", " in ["}) {
            EXPECT_THAT(help.out, Not(HasSubstr(leak))) << command;
        }
        for (const std::string& line : linesOf(help.out)) {
            EXPECT_THAT(line, SizeIs(testing::Le(80))) << command;
        }
    }
    EXPECT_THAT(run("simulate --help").out,
                AllOf(HasSubstr("simulation.start"), HasSubstr("simulation.depth.path"), HasSubstr(".bodies.json")));
    EXPECT_THAT(run("render --help").out, AllOf(HasSubstr("simulation.start"), HasSubstr(".bodies.json")));
}

TEST_F(FirstSteps, AMistypedCommandIsOneLineWithTheWordAndTheNearestCommand) {
    const auto answers = [this](const char* words, const char* word, const char* nearest, const char* help) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 1) << words;
        EXPECT_THAT(linesOf(outcome.err), SizeIs(1)) << outcome.err;
        EXPECT_THAT(outcome.err, AllOf(HasSubstr(word), HasSubstr(nearest), HasSubstr(help)));
        EXPECT_THAT(outcome.out, IsEmpty());
    };
    answers("rendr s.json -o a.png", "\"rendr\"", "\"render\"", "(sluice --help");
    answers("explian", "\"explian\"", "\"explain\"", "(sluice --help");
    answers("diag a.log", "\"diag\"", "\"diagnose\"", "(sluice --help");
    answers("foo", "\"foo\" is no command (", "", "(sluice --help");
    answers("generate pool --bogus 1 --seed 2 -o p.pos", "\"--bogus\" is no option (", "",
            "(sluice generate pool --help");
    answers("render s.json --ouptut a.png", "\"--ouptut\"", "\"--output\"", "(sluice render --help");
    answers("render s.json", "--output is required", "", "(sluice render --help");
    answers("convert a.pos b.pos c.pos d.pos", "\"c.pos\" is one argument too many", "", "(sluice convert --help");
    answers("generate pol -o p.pos", "\"pol\"", "\"pool\"", "(sluice generate --help");
}

TEST_F(FirstSteps, ANumberWithASignIsNotWrappedRound) {
    for (const char* words : {"generate pool --particles -5 -o p.pos", "generate pool --seed -1 -o p.pos",
                              "generate pool --particles 1e6 -o p.pos"}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 1) << words;
        EXPECT_THAT(outcome.err, HasSubstr(": expected a whole number, 0 or more, found \"")) << words;
    }
}

TEST_F(FirstSteps, AnEndingThatNobodyKnowsIsAWrongCommandLine) {
    write("p.pos", "");
    for (const char* words : {"generate pool -o p.xyz", "generate pool -o sub/p.xyz", "convert p.pos p.xyz"}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 1) << words;
        EXPECT_THAT(outcome.err, HasSubstr("p.xyz: expected the ending .pos, .ply")) << words;
    }
    EXPECT_THAT(files(), testing::ElementsAre("p.pos"));
}

TEST_F(FirstSteps, AWrongValueIsAnsweredWithTheRightOnes) {
    const auto answer = [this](const std::string& words) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 1) << words;
        return linesOf(outcome.err).front();
    };
    EXPECT_EQ(answer("render s.json -o a.png --timeline fast"),
              "sluice: error: --timeline: expected one of auto, native, binary, bridged, finish, found \"fast\"");
    EXPECT_EQ(answer("render s.json -o a.png --depth-format 12"),
              "sluice: error: --depth-format: expected one of auto, D32F, R32F, found \"12\"");
    EXPECT_EQ(answer("render s.json -o a.png --view Depth"),
              "sluice: error: --view: expected one of fluid, depth, normal, thickness, found \"Depth\"");
    EXPECT_EQ(answer("render s.json -o a.png --image-sets 5"),
              "sluice: error: --image-sets: expected 1 to 4, found \"5\"");
    EXPECT_EQ(answer("convert a.ply a.pos --radius 0"),
              "sluice: error: --radius: expected metres above 0, found \"0\"");
}

TEST_F(FirstSteps, ASceneWithoutParticlesSaysWhereTheyAreNamedAndHowTheyAreMade) {
    write("s.json", "{}");
    for (const char* words : {"explain s.json", "render s.json -o a.png"}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 2);
        EXPECT_THAT(linesOf(outcome.err), SizeIs(1));
        EXPECT_THAT(outcome.err, AllOf(HasSubstr("s.json: /particles/path: "), HasSubstr("--particles FILE"),
                                       HasSubstr("sluice generate pool -o pool.pos")));
    }
    // The advice is good.
    ASSERT_EQ(run("generate pool -o pool.pos --particles 2000").code, 0);
    EXPECT_EQ(run("explain s.json --particles pool.pos").code, 0);
}

TEST_F(FirstSteps, AnInputWithoutRadiusCannotBeConvertedUntilOneIsGiven) {
    writePlyWithoutRadius("w.ply");
    const Outcome without = run("convert w.ply w.pos");
    EXPECT_EQ(without.code, 2);
    EXPECT_THAT(without.err,
                AllOf(HasSubstr("w.ply: "), HasSubstr("no particle radius"), HasSubstr("--radius METRES")));
    EXPECT_FALSE(exists("w.pos"));
    const Outcome with = run("convert w.ply w.pos --radius 0.02");
    EXPECT_EQ(with.code, 0) << with.err;
    EXPECT_EQ(with.err, "");
    EXPECT_THAT(with.out, HasSubstr("radius 0.02000 m"));
}

TEST_F(FirstSteps, TheScenesRadiusIsTakenWithOneWarningThatNamesFileRadiusAndPlace) {
    writePlyWithoutRadius("w_0001.ply");
    writePlyWithoutRadius("w_0002.ply");
    write("s.json", R"({"particles": {"path": "w_####.ply", "radius": 0.0125}, "size": [64, 36]})");
    for (const char* words : {"explain s.json", "render s.json -o a_##.png --frames 1..2"}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_THAT(linesOf(outcome.err), SizeIs(1)) << outcome.err;
        EXPECT_THAT(outcome.err, AllOf(HasSubstr("warning: "), HasSubstr("w_0001.ply: "), HasSubstr("0.0125 m"),
                                       HasSubstr("/particles/radius in s.json")));
    }
    EXPECT_EQ(run("render s.json -o a_##.png --frames 1..2 --quiet").err, "");
    // A file with a radius of its own takes that without a word.
    ASSERT_EQ(run("convert w_0001.ply own.ply --radius 0.02").code, 0);
    const Outcome own = run("render s.json --particles own.ply -o a.png");
    EXPECT_EQ(own.err, "");
    EXPECT_THAT(own.out, HasSubstr("radius 0.02000 m"));
}

TEST_F(FirstSteps, ASceneWithoutARadiusForSuchFilesSaysWhereToSetIt) {
    writePlyWithoutRadius("w.ply");
    write("s.json", R"({"particles": {"path": "w.ply"}})");
    const Outcome outcome = run("render s.json -o a.png");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("w.ply: "), HasSubstr("no particle radius"),
                                   HasSubstr(R"("particles": {"radius": METRES})"), HasSubstr("convert --radius")));
}

TEST_F(FirstSteps, TheManualsSynopsisIsWhatHelpSays) {
    const std::vector<std::string> lines = manualLines("```");
    EXPECT_THAT(lines, SizeIs(8));
    for (const std::string& line : lines) {
        const std::string usage = line.substr(0, line.find("  "));
        const auto argument = std::find_if(usage.begin() + 7, usage.end(),
                                           [](char c) { return c == '[' || c == '-' || (c >= 'A' && c <= 'Z'); });
        EXPECT_THAT(linesOf(run(std::string(usage.begin() + 7, argument) + "--help").out),
                    testing::Contains("Usage: " + usage));
    }
}

TEST_F(FirstSteps, EveryCommandOfTheManualRuns) {
    const std::vector<std::string> lines = manualLines("```sh");
    EXPECT_THAT(lines, Not(IsEmpty()));
    for (std::string line : lines) {
        if (const std::size_t sample = line.find("samples/"); sample != std::string::npos) {
            line.insert(sample, SLUICE_SOURCE "/");
        }
        const Outcome outcome = run(line.substr(7));
        EXPECT_EQ(outcome.code, 0) << line << "\n" << outcome.err;
        EXPECT_EQ(outcome.err, "") << line;
    }
}

}  // namespace
}  // namespace sluice::test
