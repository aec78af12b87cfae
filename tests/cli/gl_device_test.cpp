// SPDX-License-Identifier: MIT
// What the user is told where EGL lists a graphics card and OpenGL draws in software.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "program.hpp"
#include "report/probe_report.hpp"

namespace sluice::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kNote = "although EGL device";

/// Beside the drivers of this machine there is egl_card/vendor.c.
class GlDevice : public ProgramTest {
  protected:
    void SetUp() override {
        ASSERT_NO_FATAL_FAILURE(ProgramTest::SetUp());
        writeParticles("p.pos", 4);
        writeScene("s.json", "p.pos");
        // Without a renderer, which would prove every format first.
        probe_ = nlohmann::json::parse(withCard("probe --json --plugin none.so", "").out);
        const auto renderer = probe_.at("gl").at("renderer").get<std::string>();
        if (renderer.find("llvmpipe") == std::string::npos) {
            GTEST_SKIP() << "this machine's own OpenGL is '" << renderer << "', no software renderer";
        }
        for (const auto& device : probe_.at("egl_devices")) {
            const bool card = device.get<std::string>().find("EGL_SLUICE_card_of_a_test") != std::string::npos;
            (card ? card_ : software_) = device.get<std::string>().substr(0, device.get<std::string>().find(':'));
        }
        ASSERT_NE(card_, "") << probe_.at("egl_devices");
    }

    [[nodiscard]] Outcome withCard(const std::string& words, const std::string& device) const {
        return run(words, "env __EGL_VENDOR_LIBRARY_DIRS=" SLUICE_EGL_CARD_DIR
                          ":/etc/glvnd/egl_vendor.d:/usr/share/glvnd/egl_vendor.d SLUICE_GL_DEVICE=" +
                              device);
    }

    nlohmann::json probe_;
    std::string card_, software_;  ///< indices of EGL devices
};

TEST_F(GlDevice, OfACardThatIsNotUsedIsNamedByProbe) {
    const auto note = probe_.at("gl_device_note").get<std::string>();
    EXPECT_THAT(note, AllOf(HasSubstr(kNote), HasSubstr("set SLUICE_GL_DEVICE=" + card_ + " to use it")));
    EXPECT_THAT(withCard("probe --plugin none.so", "").out, HasSubstr("\nnote      " + note + "\n"));
}

TEST_F(GlDevice, OfACardThatIsNotUsedIsNamedOnceByRender) {
    const Outcome outcome = withCard("render s.json -o a_#.png --frames 1..2", "");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::size_t first = outcome.err.find(kNote);
    ASSERT_NE(first, std::string::npos) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("warning: OpenGL is the software renderer"));
    EXPECT_EQ(outcome.err.find(kNote, first + 1), std::string::npos) << outcome.err;
    EXPECT_EQ(withCard("render s.json -o b.png --quiet", "").err, "");
}

TEST_F(GlDevice, OfWhoAskedForTheSoftwareRendererIsNotQuestioned) {
    EXPECT_EQ(withCard("render s.json -o a.png", "surfaceless").err, "");
    EXPECT_TRUE(nlohmann::json::parse(withCard("probe --json --plugin none.so", "surfaceless").out)
                    .at("gl_device_note")
                    .is_null());
    if (!software_.empty()) {
        EXPECT_EQ(withCard("render s.json -o b.png", software_).err, "");
    }
}

TEST_F(GlDevice, WithoutDriverFailsByItsIndex) {
    const Outcome outcome = withCard("render s.json -o a.png", card_);
    EXPECT_EQ(outcome.code, 4);
    EXPECT_THAT(outcome.err, HasSubstr("SLUICE_GL_DEVICE=" + card_ + ": "));
    EXPECT_FALSE(exists("a.png"));
    EXPECT_THAT(withCard("probe", card_).out,
                AllOf(HasSubstr("OpenGL    none: see the problem below\n"), HasSubstr("problem   "),
                      Not(HasSubstr("\nnote ")), Not(HasSubstr("GL_EXT_memory_object"))));
}

std::size_t occurrences(const std::string& text, const std::string& of) {
    std::size_t count = 0;
    for (std::size_t at = text.find(of); at != std::string::npos; at = text.find(of, at + 1)) {
        ++count;
    }
    return count;
}

TEST(ProbeText, HasOneVerdictAndEachReasonOnce) {
    cli::ProbeResult probe;
    probe.gl.renderer[0] = 'x';
    probe.vk.emplace();
    probe.same_device = true;
    for (const SluiceFormat format : {SLUICE_FORMAT_RGBA8, SLUICE_FORMAT_R32F, SLUICE_FORMAT_D32F}) {
        probe.formats.emplace_back().format = format;
        probe.formats.back().canaries = {{67, 43, false, "a lack"}, {1283, 717, false, "a lack"}};
    }
    const std::string without = cli::probeText(probe);
    EXPECT_EQ(occurrences(without, "verdict "), 1U) << without;
    EXPECT_EQ(occurrences(without, " can share"), 0U) << without;
    EXPECT_EQ(occurrences(without, "a lack"), 1U) << without;
    EXPECT_EQ(occurrences(without, "FAILED [1]"), 6U) << without;
    probe.agreement.emplace();
    EXPECT_THAT(cli::probeText(probe), HasSubstr("verdict   GL and Vulkan can share images here.\n"));
    probe.vk.reset();
    probe.agreement.reset();
    EXPECT_THAT(cli::probeText(probe), HasSubstr("verdict   GL and Vulkan cannot share images here.\n"));
}

TEST_F(GlDevice, WithoutSharedMemoryOneLineSaysSo) {
    const Outcome outcome = run("probe", "env MESA_EXTENSION_OVERRIDE=-GL_EXT_memory_object_fd");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("problem   shared memory: GL_EXT_memory_object_fd is missing"),
                                   HasSubstr("verdict   GL and Vulkan cannot share images here.\n"),
                                   HasSubstr("not tried"), Not(HasSubstr("FAILED"))));
}

}  // namespace
}  // namespace sluice::test
