// SPDX-License-Identifier: MIT
// What `sluice render`, `probe` and `explain` produce, with the real plugin.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace sluice::test {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAreArray;

struct Image {
    OIIO::ImageSpec spec;
    std::vector<float> values;
    [[nodiscard]] float at(int x, int y, const std::string& channel) const {
        const int c = spec.channelindex(channel);
        const std::ptrdiff_t pixel = std::ptrdiff_t{y} * spec.width + x;
        return values[static_cast<std::size_t>(pixel * spec.nchannels + c)];
    }
};

Image readImage(const std::filesystem::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    Image image;
    if (input) {
        image.spec = input->spec();
        image.values.resize(static_cast<std::size_t>(image.spec.width) * static_cast<std::size_t>(image.spec.height) *
                            static_cast<std::size_t>(image.spec.nchannels));
        EXPECT_TRUE(input->read_image(0, 0, 0, image.spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data()));
    }
    return image;
}

class Render : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        writeParticles("p.pos", 12);
        writeScene("s.json", "p.pos");
    }
};

TEST_F(Render, FluidChangesTheCentreAndLeavesTheCornersAlone) {
    ASSERT_EQ(run("render s.json -o bare.png --no-fluid").code, 0);
    const Outcome outcome = run("render s.json -o wet.png");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Image bare = readImage(at("bare.png"));
    const Image wet = readImage(at("wet.png"));
    ASSERT_EQ(wet.spec.width, 160);
    ASSERT_EQ(wet.spec.height, 90);
    ASSERT_EQ(wet.spec.nchannels, 3);
    EXPECT_EQ(wet.spec.format, OIIO::TypeDesc::UINT8);
    const auto differs = [&](int x, int y) {
        return wet.at(x, y, "R") != bare.at(x, y, "R") || wet.at(x, y, "G") != bare.at(x, y, "G");
    };
    EXPECT_TRUE(differs(80, 45));
    EXPECT_FALSE(differs(0, 0));
    EXPECT_FALSE(differs(159, 89));
}

TEST_F(Render, TwoRendersAreTheSameFiles) {
    const std::string words = "render s.json --layers l.exr --size 97x61 -o ";
    ASSERT_EQ(run(words + "a.png").code, 0);
    const std::string layers = read("l.exr");
    ASSERT_EQ(run(words + "b.png").code, 0);
    EXPECT_FALSE(layers.empty());
    EXPECT_TRUE(layers == read("l.exr"));
    EXPECT_TRUE(read("a.png") == read("b.png"));
}

TEST_F(Render, LayersHaveTheirNamesSizesAndMeanings) {
    const Outcome outcome = run("render s.json -o a.png --layers a.exr");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Image exr = readImage(at("a.exr"));
    ASSERT_EQ(exr.spec.width, 160);
    ASSERT_EQ(exr.spec.height, 90);
    const std::vector<std::string> expected{"R",       "G",        "B",        "A",        "host.R",     "host.G",
                                            "host.B",  "host.Z",   "fluid.R",  "fluid.G",  "fluid.B",    "fluid.A",
                                            "fluid.Z", "normal.X", "normal.Y", "normal.Z", "thickness.Y"};
    ASSERT_THAT(exr.spec.channelnames, UnorderedElementsAreArray(expected));
    // The camera looks at the middle of a cube of side 1, 2.9 m away; the cube's near side is within 0.87 m of that.
    EXPECT_GT(exr.at(80, 45, "fluid.A"), 0.9F);
    EXPECT_NEAR(exr.at(80, 45, "fluid.Z"), 2.92F, 0.87F);
    EXPECT_LT(exr.at(80, 45, "fluid.Z"), exr.at(80, 45, "host.Z"));
    EXPECT_NEAR(std::hypot(exr.at(80, 45, "normal.X"), exr.at(80, 45, "normal.Y"), exr.at(80, 45, "normal.Z")), 1.0F,
                0.01F);
    EXPECT_GT(exr.at(80, 45, "thickness.Y"), 0.3F);
    EXPECT_LT(exr.at(80, 45, "thickness.Y"), 3.0F);
    EXPECT_EQ(exr.at(0, 0, "fluid.A"), 0.0F);
    EXPECT_TRUE(std::isinf(exr.at(0, 0, "fluid.Z")));
    EXPECT_EQ(exr.at(0, 0, "thickness.Y"), 0.0F);
    // Where there is no fluid, the picture is the host's.
    EXPECT_EQ(exr.at(0, 0, "R"), exr.at(0, 0, "host.R"));
    EXPECT_NE(exr.at(80, 45, "R"), exr.at(80, 45, "host.R"));
}

TEST_F(Render, JsonSummaryHasEveryField) {
    const Outcome outcome = run("render s.json -o a_%03d.png --frames 1..3 --json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto summary = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(summary.at("frames").at("written"), 3);
    EXPECT_EQ(summary.at("frames").at("with_fluid"), 3);
    EXPECT_EQ(summary.at("particles").at("count"), 12 * 12 * 12);
    EXPECT_EQ(summary.at("size"), nlohmann::json({160, 90}));
    EXPECT_EQ(summary.at("exit_code"), 0);
    EXPECT_EQ(summary.at("bytes").at("cpu_copied_shared_images"), 0);
    EXPECT_EQ(summary.at("bytes").at("read_back_for_files"), 3 * 160 * 90 * 4);
    EXPECT_FALSE(summary.at("renderer").at("timeline_reason").get<std::string>().empty());
    EXPECT_EQ(summary.at("renderer").at("formats").at("HOST_COLOUR"), "RGBA8");
    bool splat = false;
    for (const auto& pass : summary.at("passes")) {
        EXPECT_EQ(pass.at("frames"), 3);
        EXPECT_GT(pass.at("bytes"), 0);
        if (pass.at("name") == "splat_depth") {
            splat = true;
            EXPECT_EQ(pass.at("elements"), 12 * 12 * 12);
            EXPECT_EQ(pass.at("elements_are"), "particles");
        }
    }
    EXPECT_TRUE(splat);
    EXPECT_TRUE(exists("a_001.png") && exists("a_002.png") && exists("a_003.png"));
}

TEST_F(Render, QuietPrintsNothing) {
    const Outcome outcome = run("render s.json -o a.png --quiet");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
    EXPECT_TRUE(exists("a.png"));
}

TEST_F(Render, EveryTimelineThatIsPossibleGivesTheSamePicture) {
    ASSERT_EQ(run("render s.json -o auto.png").code, 0);
    const auto probe = nlohmann::json::parse(run("probe --json").out);
    int tried = 0;
    for (const auto& timeline : probe.at("timelines")) {
        const auto kind = timeline.at("kind").get<std::string>();
        const int code = run("render s.json -o k.png --frames 1 --timeline " + kind).code;
        EXPECT_EQ(code, timeline.at("possible").get<bool>() ? 0 : 3) << kind;
        if (code == 0) {
            EXPECT_TRUE(read("k.png") == read("auto.png")) << kind;
            ++tried;
        }
    }
    EXPECT_GE(tried, 2);  // finish and, with fences, bridged
}

TEST_F(Render, TheTraceShowsTheHandOffAndNoCopyOfASharedImage) {
    ASSERT_EQ(run("render s.json -o a_##.png --frames 1..4 --trace t.json").code, 0);
    const auto trace = nlohmann::json::parse(read("t.json"));
    const auto& events = trace.is_array() ? trace : trace.at("traceEvents");
    int passes = 0;
    int signals = 0;
    std::vector<std::string> copies;
    for (const auto& event : events) {
        const std::string category = event.value("cat", "");
        const std::string name = event.value("name", "");
        passes += event.value("ph", "") == "X" && name.find("splat_depth") != std::string::npos ? 1 : 0;
        signals += category.find("signal") != std::string::npos ? 1 : 0;
        if (category.find("copy") != std::string::npos) {
            copies.push_back(name);
        }
    }
    EXPECT_EQ(passes, 4);
    EXPECT_GE(signals, 12);  // 2k-1, 2k and k of four frames
    EXPECT_FALSE(copies.empty());
    for (const std::string& name : copies) {
        EXPECT_TRUE(name.find("read") != std::string::npos || name.find("upload") != std::string::npos) << name;
    }
}

TEST_F(Render, SequencesAndPatternsGoTogether) {
    writeParticles("q_0005.pos", 6);
    writeParticles("q_0006.pos", 8);
    const Outcome outcome = run("render s.json --particles q_%04d.pos -o deep/er/a_#####.png --frames 5..6 --json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(exists("deep/er/a_00005.png") && exists("deep/er/a_00006.png"));
    EXPECT_FALSE(read("deep/er/a_00005.png") == read("deep/er/a_00006.png"));
    EXPECT_EQ(nlohmann::json::parse(outcome.out).at("particles").at("count"), 512);
}

TEST_F(Render, RangesByTwoProcessesAtOnceAreTheFramesOfOneRun) {
    for (const unsigned frame : {1U, 2U, 3U, 4U, 5U}) {
        writeParticles(fmt::format("q_{}.pos", frame), 3 + frame);
    }
    const std::string options = "--particles q_#.pos --layers";
    ASSERT_EQ(run("render s.json " + options + " whole_#.exr -o whole_#.png --frames 1..5").code, 0);
    // The tasks of an array job of two, as Slurm would start them.
    const std::string task = fmt::format(
        "SLURM_ARRAY_TASK_MIN=7 SLURM_ARRAY_TASK_COUNT=2 {}/scripts/render-ranges.sbatch s.json 1 5 --quiet {} "
        "part_#.exr "
        "-o part_#.png",
        SLUICE_SOURCE, options);
    const std::string both = fmt::format(
        "cd '{}' && unset SLUICE_PLUGIN && export PATH=\"$(dirname '{}'):$PATH\" && {{ SLURM_ARRAY_TASK_ID=8 {} & }} "
        "&& "
        "SLURM_ARRAY_TASK_ID=7 {} && wait $!",
        at("").string(), SLUICE_PROGRAM, task, task);
    ASSERT_EQ(std::system(both.c_str()), 0);
    for (const char* frame :
         {"1.png", "2.png", "3.png", "4.png", "5.png", "1.exr", "2.exr", "3.exr", "4.exr", "5.exr"}) {
        EXPECT_FALSE(read(fmt::format("part_{}", frame)).empty()) << frame;
        EXPECT_TRUE(read(fmt::format("part_{}", frame)) == read(fmt::format("whole_{}", frame))) << frame;
    }
}

TEST_F(Render, EnvironmentMapsChangeTheReflection) {
    ASSERT_EQ(run("render s.json -o sky.png").code, 0);
    OIIO::ImageSpec spec(64, 32, 3, OIIO::TypeDesc::FLOAT);
    const std::vector<float> red(std::size_t{64} * 32 * 3, 0.0F);
    std::vector<float> pixels = red;
    for (std::size_t i = 0; i < pixels.size(); i += 3) {
        pixels[i] = 4.0F;
    }
    const auto output = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(output && output->open(at("env.exr").string(), spec) &&
                output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && output->close());
    writeScene("env.json", "p.pos", R"(, "environment": "env.exr")");
    ASSERT_EQ(run("render env.json -o env.png").code, 0);
    const Image sky = readImage(at("sky.png"));
    const Image env = readImage(at("env.png"));
    EXPECT_GT(env.at(80, 45, "R"), sky.at(80, 45, "R"));
    EXPECT_EQ(env.at(0, 0, "R"), sky.at(0, 0, "R"));
}

TEST_F(Render, ExplainNamesEveryPassOnce) {
    const Outcome text = run("explain s.json");
    ASSERT_EQ(text.code, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("splat_depth"));
    writeScene(
        "plain.json", "p.pos",
        R"(, "fluid": {"refraction": false, "absorption": [0,0,0], "scatter_colour": [0,0,0], "filter": "none"})");
    const auto full = nlohmann::json::parse(run("explain s.json --json").out);
    const auto plain = nlohmann::json::parse(run("explain plain.json --json").out);
    const auto kept = [](const nlohmann::json& document, const std::string& name) {
        for (const auto& pass : document.at("passes")) {
            if (pass.at("pass") == name) {
                EXPECT_FALSE(pass.at("reason").get<std::string>().empty());
                return pass.at("kept").get<bool>();
            }
        }
        ADD_FAILURE() << name << " is not in the plan";
        return false;
    };
    EXPECT_TRUE(kept(full, "filter") && kept(full, "splat_thickness") && kept(full, "shade"));
    EXPECT_FALSE(kept(plain, "filter") || kept(plain, "splat_thickness"));
}

TEST_F(Render, ProbeAgreesWithWhatRenderUses) {
    const Outcome outcome = run("probe --json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto probe = nlohmann::json::parse(outcome.out);
    EXPECT_TRUE(probe.at("possible").get<bool>());
    EXPECT_TRUE(probe.at("same_device").get<bool>());
    EXPECT_TRUE(probe.at("egl_devices").is_array());
    EXPECT_EQ(probe.at("gl").at("driver_uuid"), probe.at("vulkan").at("driver_uuid"));
    for (const auto& format : probe.at("formats")) {
        for (const auto& canary : format.at("canaries")) {
            EXPECT_TRUE(canary.at("passed").get<bool>() || !canary.at("why").get<std::string>().empty());
        }
    }
    const auto summary = nlohmann::json::parse(run("render s.json -o a.png --json").out);
    EXPECT_EQ(summary.at("renderer").at("timeline"), probe.at("agreement").at("timeline"));
    EXPECT_EQ(summary.at("renderer").at("formats").at("HOST_DEPTH"),
              probe.at("agreement").at("formats").at("HOST_DEPTH"));
}

}  // namespace
}  // namespace sluice::test
