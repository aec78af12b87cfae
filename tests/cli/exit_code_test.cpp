// SPDX-License-Identifier: MIT
// Exit codes of the real program, and what it leaves behind when something is wrong.
#include <gmock/gmock.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "program.hpp"

namespace sluice::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ExitCode : public ProgramTest {};

TEST_F(ExitCode, HelpAndVersionAreSuccess) {
    EXPECT_EQ(run("--help").code, 0);
    const Outcome help = run("render --help");
    EXPECT_EQ(help.code, 0);
    EXPECT_THAT(help.out, HasSubstr("Exit codes:"));
    const Outcome version = run("--version");
    EXPECT_EQ(version.code, 0);
    EXPECT_THAT(version.out, HasSubstr("sluice "));
}

TEST_F(ExitCode, EverySampleThatHelpNamesExists) {
    const std::string help = run("--help").out;
    const std::regex sample("samples/[A-Za-z0-9_.-]+[.]json");
    const auto first = std::sregex_iterator(help.begin(), help.end(), sample);
    EXPECT_GE(std::distance(first, std::sregex_iterator()), 1);
    for (auto it = first; it != std::sregex_iterator(); ++it) {
        EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(SLUICE_SOURCE) / it->str())) << it->str();
    }
}

TEST_F(ExitCode, WrongCommandLinesAreOne) {
    EXPECT_EQ(run("render s.json -o a.png -o b.png").err,
              "sluice: error: --output may be given once, found it 2 times\n");
    writeParticles("p.pos", 4);
    writeScene("s.json", "p.pos");
    for (const char* words :
         {"", "render", "render s.json", "render s.json -o a.png --frames 5..1", "render s.json -o a.png --size 3",
          "render s.json -o a.png --timeline fast", "render s.json -o a.png --image-sets 9",
          "render s.json -o a.png --frames 1..2", "render s.json -o a.jpg", "render s.json -o a.png --layers a.png",
          "render s.json -o a.png --json --quiet", "generate", "generate pool", "paint none.json"}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 1) << words << "\n" << outcome.err;
        EXPECT_FALSE(outcome.err.empty()) << words;
    }
    EXPECT_THAT(files(), ElementsAre("p.pos", "s.json"));
}

TEST_F(ExitCode, MissingAndBrokenScenesAreTwo) {
    EXPECT_EQ(run("render none.json -o a.png").code, 2);
    write("broken.json", "{\"particles\": ");
    const Outcome outcome = run("render broken.json -o a.png");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("broken.json: not a JSON document"));
    EXPECT_EQ(run("explain broken.json").code, 2);
    EXPECT_THAT(files(), ElementsAre("broken.json"));
}

/// A .pos with this count in its head, this radius, and this many floats that follow.
std::string pos(std::uint32_t count, float radius, const std::vector<float>& values) {
    std::string bytes(8 + 4 * values.size(), '\0');
    std::memcpy(bytes.data(), &count, 4);
    std::memcpy(bytes.data() + 4, &radius, 4);
    if (!values.empty()) {
        std::memcpy(bytes.data() + 8, values.data(), 4 * values.size());
    }
    return bytes;
}

TEST_F(ExitCode, BadParticleFilesAreTwoAndLeaveNoOutput) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    write("truncated.pos", pos(3, 0.1F, {0, 0, 0}));
    write("nan.pos", pos(1, 0.1F, {0, nan, 0}));
    write("zero.pos", "");
    write("absurd.pos", pos(4'000'000'000U, 0.1F, {0, 0, 0}));
    write("magic.bgeo", "not a bgeo file at all");
    write("magic.ply", "plx\nformat ascii 1.0\n");
    writeScene("s.json", "unused.pos");
    const std::vector<std::string> before = files();
    for (const char* name : {"truncated.pos", "nan.pos", "zero.pos", "absurd.pos", "magic.bgeo", "magic.ply",
                             "missing.pos", "unknown.xyz"}) {
        const Outcome outcome =
            run(std::string("render s.json -o a.png --layers a.exr --trace a.json --particles ") + name);
        EXPECT_EQ(outcome.code, 2) << name;
        EXPECT_THAT(outcome.err, HasSubstr(name));
        EXPECT_EQ(files(), before) << name;
    }
}

TEST_F(ExitCode, AFileOfNoParticlesIsAFrameWithoutFluidAndAWarning) {
    write("none.pos", pos(0, 0.1F, {}));
    writeScene("s.json", "none.pos");
    const Outcome outcome = run("render s.json -o a.png");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("none.pos: holds no particles"));
    ASSERT_EQ(run("render s.json -o bare.png --no-fluid").code, 0);
    EXPECT_TRUE(read("a.png") == read("bare.png"));
}

TEST_F(ExitCode, ABadFrameLaterInASequenceIsFoundBeforeTheFirstOutput) {
    writeParticles("f_0001.pos", 4);
    write("f_0002.pos", pos(3, 0.1F, {0, 0, 0}));
    writeScene("s.json", "f_####.pos");
    const std::vector<std::string> before = files();
    const Outcome outcome = run("render s.json -o a_####.png --frames 1..2");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("f_0002.pos"));
    EXPECT_EQ(files(), before);
}

TEST_F(ExitCode, ABadEnvironmentMapIsTwo) {
    writeParticles("p.pos", 4);
    write("sky.exr", "no image");
    writeScene("s.json", "p.pos", R"(, "environment": "sky.exr")");
    const Outcome outcome = run("render s.json -o a.png");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("sky.exr"));
    EXPECT_FALSE(exists("a.png"));
}

TEST_F(ExitCode, AMissingOrBrokenPluginIsThreeAndTheFrameIsStillWritten) {
    writeParticles("p.pos", 4);
    writeScene("s.json", "p.pos");
    write("fake.so", "not a shared object");
    ASSERT_EQ(run("render s.json -o bare.png --no-fluid").code, 0);
    for (const char* plugin : {"/nonexistent/plugin.so", "./fake.so"}) {
        const Outcome outcome = run(std::string("render s.json -o a.png --json --plugin ") + plugin);
        EXPECT_EQ(outcome.code, 3) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(plugin));
        EXPECT_EQ(read("a.png"), read("bare.png"));
        const auto summary = nlohmann::json::parse(outcome.out);
        EXPECT_EQ(summary.at("exit_code"), 3);
        EXPECT_EQ(summary.at("problems").size(), 1U);
        EXPECT_EQ(summary.at("frames").at("with_fluid"), 0);
    }
    const Outcome quiet = run("render s.json -o a.png --quiet --plugin /nonexistent/plugin.so");
    EXPECT_EQ(quiet.code, 3);
    EXPECT_EQ(quiet.out, "");
    EXPECT_FALSE(quiet.err.empty());
    EXPECT_EQ(run("probe --plugin /nonexistent/plugin.so").code, 3);
    EXPECT_EQ(run("explain s.json --plugin /nonexistent/plugin.so").code, 3);
}

TEST_F(ExitCode, WithoutTheModuleForPicturesARenderIsFourBeforeItsFirstFrameAndTheRestRuns) {
    writeParticles("p.pos", 4);
    writeScene("s.json", "p.pos");
    // $0 is the program: a copy of it stands alone.
    const std::string alone = R"(sh -c 'mkdir -p bin; cp -n "$0" bin/sluice; exec bin/sluice "$@"')";
    const Outcome missing = run("render s.json -o new/a.png --no-fluid", alone);
    EXPECT_EQ(missing.code, 4) << missing.err;
    EXPECT_THAT(missing.err, HasSubstr("bin/libsluice_images.so and "));
    write("bin/libsluice_images.so", "not a shared object");
    const Outcome broken = run("render s.json -o new/a.png --no-fluid", alone);
    EXPECT_EQ(broken.code, 4) << broken.err;
    EXPECT_THAT(broken.err, HasSubstr("libsluice_images.so"));
    EXPECT_THAT(files(), ElementsAre("bin", "p.pos", "s.json"));
    EXPECT_EQ(run("convert p.pos q.pos", alone).code, 0);
}

TEST_F(ExitCode, AnOutputThatCannotBeWrittenIsFourAndLeavesNoTemporary) {
    writeParticles("p.pos", 4);
    writeScene("s.json", "p.pos");
    write("taken.png/inside", "a folder in the way");
    const Outcome outcome = run("render s.json -o taken.png --no-fluid");
    EXPECT_EQ(outcome.code, 4);
    EXPECT_THAT(outcome.err, HasSubstr("taken.png"));
    EXPECT_THAT(files(), ElementsAre("p.pos", "s.json", "taken.png"));
}

TEST_F(ExitCode, AnInterruptFinishesTheFileInHand) {
    writeParticles("p.pos", 4);
    writeScene("s.json", "p.pos");
    constexpr int kMoreThanTimeAllows = 20'000;
    const Outcome outcome = run(
        "render s.json -o a_#####.png --no-fluid --quiet --frames 1.." + std::to_string(kMoreThanTimeAllows),
        // Interrupts once the second frame is there; a shell makes what it starts in the background deaf to Ctrl-C.
        "sh -c 'env --default-signal=INT \"$@\" & program=$!; "
        "until [ -e a_00002.png ] || ! kill -0 $program; do sleep 0.05; done; kill -INT $program; wait $program' sh");
    EXPECT_EQ(outcome.code, 130);
    const std::vector<std::string> names = files();
    EXPECT_GT(names.size(), 2U);
    EXPECT_LT(names.size(), kMoreThanTimeAllows);
    for (const std::string& name : names) {
        EXPECT_EQ(name.find("partial"), std::string::npos) << name;
        if (name.ends_with(".png")) {
            // The last chunk of a whole PNG.
            EXPECT_NE(read(name).find("IEND"), std::string::npos) << name;
        }
    }
}

}  // namespace
}  // namespace sluice::test
