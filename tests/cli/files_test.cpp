// SPDX-License-Identifier: MIT
// Which files the real program refuses to write, and what a failed run leaves behind.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace sluice::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Files : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        writeParticles("p.pos", 4);
        writeScene("s.json", "p.pos");
    }
};

struct Clash {
    std::string words, file, first, second;
};

class FileClash : public Files, public ::testing::WithParamInterface<Clash> {};

TEST_P(FileClash, IsAUsageErrorThatNamesBothRolesAndDestroysNothing) {
    writeParticles("f_0001.pos", 4);
    writeParticles("f_0002.pos", 4);
    write("env.png", "is looked at later than its name");
    write("plugin.png", "so is this");
    writeScene("env.json", "p.pos", R"(, "environment": "env.png")");
    writeScene("seq.json", "f_####.pos");
    std::filesystem::create_symlink("s.json", at("link.json"));
    std::filesystem::create_hard_link(at("s.json"), at("hard.json"));
    std::filesystem::create_directory(at("sub"));
    const std::vector<std::string> before = files();
    const std::string bytes = read(GetParam().file);
    const Outcome outcome = run(GetParam().words);
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_THAT(outcome.err,
                AllOf(HasSubstr(GetParam().file), HasSubstr(GetParam().first), HasSubstr(GetParam().second)));
    EXPECT_EQ(files(), before);
    EXPECT_TRUE(read(GetParam().file) == bytes);
}

INSTANTIATE_TEST_SUITE_P(
    Table, FileClash,
    ::testing::Values(
        Clash{"render s.json -o a.png --trace s.json", "s.json", "the scene file", "the trace (--trace)"},
        Clash{"render s.json -o a.png --trace sub/../s.json", "s.json", "the scene file", "the trace (--trace)"},
        Clash{"render s.json -o a.png --trace link.json", "link.json", "the scene file", "the trace (--trace)"},
        Clash{"render s.json -o a.png --trace hard.json", "hard.json", "the scene file", "the trace (--trace)"},
        Clash{"render s.json -o a.png --trace ./a.png", "a.png", "the trace (--trace)", "the picture (-o)"},
        Clash{"render s.json -o a.png --layers a.exr --trace a.exr", "a.exr", "the trace (--trace)",
              "the layers (--layers)"},
        Clash{"render s.json -o a_##.png --frames 1..9 --trace a_07.png", "a_07.png", "the trace (--trace)",
              "the picture (-o)"},
        Clash{"render s.json -o a_##.png --frames 1..2 --layers a.exr --trace a_0002.exr", "a_0002.exr",
              "the trace (--trace)", "the layers (--layers)"},
        Clash{"render s.json -o a.png --trace p.pos", "p.pos", "the particle file", "the trace (--trace)"},
        Clash{"render seq.json -o a_##.png --frames 1..2 --trace f_0002.pos", "f_0002.pos", "the particle file",
              "the trace (--trace)"},
        Clash{"render env.json -o env.png", "env.png", "the environment map", "the picture (-o)"},
        Clash{"render s.json -o plugin.png --plugin ./plugin.png", "plugin.png", "the renderer plugin",
              "the picture (-o)"},
        Clash{"convert p.pos ./p.pos", "p.pos", "the input file", "the output file"}));

TEST_F(Files, MissingFoldersOfEveryOutputAreMade) {
    const Outcome outcome = run("render s.json -o a/b/c.png --layers l/l.exr --trace t/u/t.json --no-fluid");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(exists("a/b/c.png") && exists("l/l.exr") && exists("t/u/t.json"));
    EXPECT_EQ(run("generate pool --particles 1000 -o g/h.pos").code, 0);
    EXPECT_EQ(run("convert g/h.pos i/j.ply").code, 0);
    EXPECT_TRUE(exists("g/h.pos") && exists("i/j.ply"));
}

TEST_F(Files, AnOutputPlaceThatCannotBeIsFoundBeforeTheFirstFrame) {
    write("file", "not a folder");
    write("folder.png/inside", "in the way of the second frame");
    std::filesystem::rename(at("folder.png"), at("f_2.png"));
    ASSERT_EQ(mkfifo(at("pipe").c_str(), 0600), 0);
    const std::vector<std::string> before = files();
    for (const auto& [words, name] : std::vector<std::pair<std::string, std::string>>{
             {"render s.json -o a.png --trace file/t.json", "file/t.json"},
             {"render s.json -o new/a.png --trace file/t.json", "file/t.json"},
             {"render s.json -o new/a.png --layers new2/file.exr --trace pipe", "pipe"},
             {"render s.json -o a.png --layers file/l.exr", "file/l.exr"},
             {"render s.json -o f_#.png --frames 1..2", "f_2.png"},
             {"generate pool --particles 1000 -o file/p.pos", "file/p.pos"},
             {"convert p.pos file/p.ply", "file/p.ply"}}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 4) << words << "\n" << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(name)) << words;
        EXPECT_EQ(files(), before) << words;
    }
}

TEST_F(Files, FoldersMadeForARunThatFailsGoAgain) {
    write("bad.pos", "?");
    EXPECT_EQ(run("render s.json --particles bad.pos -o new/deep/a.png").code, 2);
    EXPECT_THAT(files(), ElementsAre("bad.pos", "p.pos", "s.json"));
}

TEST_F(Files, LayersOfSeveralFramesAreNumberedAndItSaysSo) {
    const Outcome outcome =
        run("render s.json -o a_##.png --frames 2..3 --size 16x16 --layers out.exr --no-fluid --json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("out_%04d.exr"));
    EXPECT_THAT(files(), ElementsAre("a_02.png", "a_03.png", "out_0002.exr", "out_0003.exr", "p.pos", "s.json"));
    EXPECT_EQ(nlohmann::json::parse(outcome.out).at("files").size(), 4U);
}

TEST_F(Files, AParticleFileThatIsAPipeIsRefusedAtOnce) {
    ASSERT_EQ(mkfifo(at("q.pos").c_str(), 0600), 0);
    const Outcome outcome = run("render s.json --particles q.pos -o a.png", "timeout 20");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("q.pos"), HasSubstr("expected a regular file, found a pipe")));
}

TEST_F(Files, AnEnvironmentMapThatIsAPipeIsRefusedAtOnce) {
    ASSERT_EQ(mkfifo(at("sky.png").c_str(), 0600), 0);
    writeScene("env.json", "p.pos", R"(, "environment": "sky.png")");
    const Outcome outcome = run("render env.json -o a.png", "timeout 20");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("sky.png"), HasSubstr("expected a regular file")));
}

TEST_F(Files, OutOfMemoryNamesTheSizeAndTheRemedyAndKeepsWhatIsDone) {
#ifdef SLUICE_SANITIZED
    GTEST_SKIP() << "the sanitizers' shadow memory does not fit under a limit of the address space";
#endif
    // The target fits under the limit, reading it back as floats does not.
    const Outcome outcome =
        run("render s.json -o deep/a.png --no-fluid --json --size 8192x8192", "prlimit --as=2500000000 timeout 200");
    if (outcome.err.find("is not complete") != std::string::npos) {
        GTEST_SKIP() << "this driver needs more address space: " << outcome.err;
    }
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("8192x8192"), HasSubstr("not enough memory"),
                                   HasSubstr("1342177280 bytes"), HasSubstr("--size")));
    EXPECT_EQ(outcome.err.find("internal fault"), std::string::npos);
    EXPECT_EQ(nlohmann::json::parse(outcome.out).at("problems").size(), 1U);
    EXPECT_THAT(files(), ElementsAre("p.pos", "s.json"));
}

TEST_F(Files, ValidationMessagesAreShownAndMakeTheExitCodeThree) {
    const Outcome clean = run("render s.json -o a.png --validation --json");
    if (clean.err.find("the layer is not installed") != std::string::npos) {
        GTEST_SKIP() << clean.err;
    }
    EXPECT_EQ(clean.code, 0) << clean.err;
    // The layer's own switch for advice: a source of messages that are no fault.
    const Outcome outcome = run("render s.json -o a.png --validation --json",
                                "env VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT");
    const auto summary = nlohmann::json::parse(outcome.out);
    if (summary.at("validation_messages") == 0) {
        GTEST_SKIP() << "this layer gives no advice about the frame";
    }
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("error: validation: "));
    EXPECT_EQ(summary.at("frames").at("with_fluid"), 1);
    EXPECT_EQ(summary.at("problems").size(), 1U);
}

}  // namespace
}  // namespace sluice::test
