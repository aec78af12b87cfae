// SPDX-License-Identifier: MIT
// The small languages of the command line: ranges, sizes, output patterns, plugin places.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/outputs.hpp"
#include "app/parse_values.hpp"
#include "app/plugin_path.hpp"

namespace sluice::cli {
namespace {

TEST(FrameRangeText, AcceptsOneFrameAndRanges) {
    EXPECT_EQ(parseFrameRange("7").value(), (scene::FrameRange{7, 7}));
    EXPECT_EQ(parseFrameRange("0..0").value(), (scene::FrameRange{0, 0}));
    EXPECT_EQ(parseFrameRange("12..480").value(), (scene::FrameRange{12, 480}));
}

TEST(FrameRangeText, RefusesEverythingElse) {
    for (const char* text : {"", "..", "1..", "..2", "2..1", "-1..2", "1...2", "1..2..3", " 1..2", "1..2 ", "a", "1.5",
                             "0x10", "99999999999999999999", "1..1000000001", "+1"}) {
        const auto range = parseFrameRange(text);
        ASSERT_FALSE(range.ok()) << text;
        EXPECT_NE(range.error().message().find(std::string("found \"") + text + "\""), std::string::npos);
    }
}

TEST(SizeText, AcceptsPositiveSizesAndRefusesTheRest) {
    EXPECT_EQ(parseSize("1280x720").value(), (scene::Size{1280, 720}));
    EXPECT_EQ(parseSize("1x16384").value(), (scene::Size{1, 16384}));
    for (const char* text :
         {"", "x", "1x", "x1", "0x5", "5x0", "16385x1", "1280X720", "1280 x 720", "-3x4", "3x4x5", "3"}) {
        EXPECT_FALSE(parseSize(text).ok()) << text;
    }
}

TEST(FaultText, NamesWhatIsWrongWithIt) {
    const auto said = [](const char* text) {
        if (namesHostFault(text)) {
            const auto fault = parseHostFault(text);
            return fault ? std::string("nothing") : fault.error().message();
        }
        const auto fault = parseFault(text);
        return fault ? std::string("nothing") : fault.error().message();
    };
    using ::testing::HasSubstr;
    EXPECT_EQ(said("hang@3=5"), "nothing");
    EXPECT_EQ(said("drop/to-host@1=9223372036854775807"), "nothing");
    EXPECT_THAT(said("device-lost@0"), HasSubstr("frames count from 1"));
    EXPECT_THAT(said("drop@x"), HasSubstr("frames count from 1"));
    EXPECT_THAT(said("drop@"), HasSubstr("frames count from 1"));
    for (const char* text :
         {"hang@3=-5", "hang@3=", "hang@3=99999999999999999999", "wrong-value@1=18446744073709551615"}) {
        EXPECT_THAT(said(text), HasSubstr("from 0 to 9223372036854775807")) << text;
    }
    EXPECT_THAT(said("device-lost/to-host@3"), HasSubstr("without a direction"));
    for (const char* text : {"hang", "drop", "drop/@1", "fall@1", "@1", "=1"}) {
        EXPECT_THAT(said(text), HasSubstr("@FRAME[=VALUE]")) << text;
    }
}

RenderOptions outputs(const std::string& png, const std::string& exr = "") {
    RenderOptions options;
    options.output = png;
    options.layers = exr;
    return options;
}

TEST(Outputs, NeedTheirEndingsAndAPlaceForTheNumber) {
    EXPECT_TRUE(checkOutputs(outputs("a.png"), {1, 1}).ok());
    EXPECT_TRUE(checkOutputs(outputs("a_####.png", "a_%03d.exr"), {1, 9}).ok());
    EXPECT_FALSE(checkOutputs(outputs("a.jpg"), {1, 1}).ok());
    EXPECT_FALSE(checkOutputs(outputs("a.exr"), {1, 1}).ok());
    EXPECT_FALSE(checkOutputs(outputs(""), {1, 1}).ok());
    EXPECT_FALSE(checkOutputs(outputs("a.png"), {1, 2}).ok());
    EXPECT_FALSE(checkOutputs(outputs("a_##.png", "a.exr"), {1, 2}).ok());
    EXPECT_FALSE(checkOutputs(outputs("a_##_%d.png"), {1, 2}).ok());
    EXPECT_EQ(numberedPattern("out.exr", {1, 2}), "out_%04d.exr");
    EXPECT_EQ(numberedPattern("a.b/50%%.x.exr", {1, 2}), "a.b/50%%.x_%04d.exr");
    EXPECT_EQ(numberedPattern("out.exr", {7, 7}), "out.exr");
    EXPECT_EQ(numberedPattern("out_##.exr", {1, 2}), "out_##.exr");
    EXPECT_EQ(numberedPattern("a_##_%d.exr", {1, 2}), "a_##_%d.exr");  // left for checkOutputs to refuse
}

TEST(Outputs, PutTheNumberInPlace) {
    EXPECT_EQ(outputPath("o/a_####.png", 12).value(), "o/a_0012.png");
    EXPECT_EQ(outputPath("a_%04d.png", 12).value(), "a_0012.png");
    EXPECT_EQ(outputPath("a_#.png", 1234).value(), "a_1234.png");
    EXPECT_EQ(outputPath("a.png", 5).value(), "a.png");
}

TEST(PluginPlaces, TheMoreDeliberateChoiceStandsAlone) {
    using ::testing::ElementsAre;
    EXPECT_THAT(pluginCandidates("/a.so", "/b.so", "/usr/bin/sluice"), ElementsAre("/a.so"));
    EXPECT_THAT(pluginCandidates("", "/b.so", "/usr/bin/sluice"), ElementsAre("/b.so"));
    EXPECT_THAT(pluginCandidates("", "", "/usr/bin/sluice"),
                ElementsAre("/usr/bin/libsluice_renderer_vk.so", "/usr/lib/sluice/libsluice_renderer_vk.so"));
}

}  // namespace
}  // namespace sluice::cli
