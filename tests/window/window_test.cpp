// SPDX-License-Identifier: MIT
// samples/window as a person has it: events go in at the X server, and what is looked at is the screen.
#include <X11/keysym.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>

#include "desktop.hpp"
#include "orbit.hpp"
#include "picture_file.hpp"
#include "sample.hpp"
#include "world.hpp"
#include "x_server.hpp"

namespace window::test {
namespace {

constexpr const char* kTitle = "Sluice in an old engine";
constexpr unsigned kLeft = 1, kRight = 3, kWheelUp = 4;
constexpr glm::ivec2 kSize{400, 300};

/// A picture of the screenshot key, and what the program says that it shows.
struct Shot {
    Rgb picture;
    unsigned particles = 0, view = 0;
    Orbit camera;
};

class WindowSample : public ::testing::Test {
  protected:
    void SetUp() override {
        server_ = std::make_unique<sluice::test::XServer>("800x600x24");
        if (server_->display().empty() && std::getenv("SLUICE_REQUIRE_X") == nullptr) {
            GTEST_SKIP() << "NOT RUN: there is no Xvfb (apt-get install xvfb); SLUICE_REQUIRE_X=1 makes that a failure";
        }
        ASSERT_FALSE(server_->display().empty()) << "Xvfb does not start, and SLUICE_REQUIRE_X is set";
    }

    void begin(const std::vector<std::string>& arguments) {
        sample_ = std::make_unique<Sample>(server_->display(), arguments);
        hand_ = std::make_unique<Hand>(server_->display(), kTitle);
        ASSERT_TRUE(hand_->ok()) << sample_->text();
    }
    Hand& hand() { return *hand_; }

    Shot shoot() {
        std::array<char, 32> name{};
        std::snprintf(name.data(), name.size(), "window_%04d.png", ++shots_);
        const std::string said = std::string(name.data()) + ": ";
        hand().key(XK_F12);
        // The line comes after the file.
        EXPECT_TRUE(until([&] { return lineOf(said) != "" || sample_->ended(); })) << name.data();
        Shot shot;
        shot.picture = readPng(sample_->folder() / name.data());
        const std::string line = lineOf(said);
        int width = 0;
        int height = 0;
        unsigned long long frame = 0;
        EXPECT_EQ(std::sscanf(line.c_str() + std::min(said.size(), line.size()),
                              "%dx%d, frame %llu, %u particles, camera at %f and %f degrees, %f m, view %u", &width,
                              &height, &frame, &shot.particles, &shot.camera.azimuth, &shot.camera.elevation,
                              &shot.camera.distance, &shot.view),
                  8)
            << sample_->text();
        EXPECT_EQ(shot.picture.width, width);
        EXPECT_EQ(shot.picture.height, height);
        return shot;
    }

    int waitForEnd() {
        EXPECT_TRUE(until([&] { return sample_->ended().has_value(); })) << sample_->text();
        return sample_->ended().value_or(-1);
    }
    /// Nothing but the lines of the screenshots.
    void expectNoComplaint() {
        std::istringstream all(sample_->text());
        for (std::string line; std::getline(all, line);) {
            EXPECT_EQ(line.rfind("window_", 0), 0U) << line;
        }
    }

    std::unique_ptr<sluice::test::XServer> server_;
    std::unique_ptr<Sample> sample_;

  private:
    /// Of the program's text, the whole line that begins so.
    [[nodiscard]] std::string lineOf(const std::string& begin) const {
        std::istringstream all(sample_->text());
        for (std::string line; std::getline(all, line);) {
            if (line.rfind(begin, 0) == 0 && line.find("view") != std::string::npos) {
                return line;
            }
        }
        return "";
    }
    std::unique_ptr<Hand> hand_;
    int shots_ = 0;
};

/// The pillar's red, lit or not.
bool isRed(const Rgb& picture, glm::vec2 pixel) {
    const int x = static_cast<int>(pixel.x);
    const int y = static_cast<int>(pixel.y);
    if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) {
        return false;
    }
    const std::uint8_t* rgb = picture.at(x, y);
    return rgb[0] > 60 && rgb[0] > 2 * rgb[1] && rgb[0] > 2 * rgb[2];
}

/// The upper part of the red pillar as the camera of the picture sees it: all of four places on its axis.
bool pillarIsSeen(const Shot& shot) {
    const glm::ivec2 size{shot.picture.width, shot.picture.height};
    const Box& pillar = redPillar();
    constexpr std::array<float, 4> kParts{0.2F, 0.4F, 0.6F, 0.8F};
    return std::all_of(kParts.begin(), kParts.end(), [&](float part) {
        const glm::vec3 place = pillar.centre + glm::vec3(0.0F, part * pillar.half.y, 0.0F);
        return isRed(shot.picture, pixelOf(shot.camera, size, place));
    });
}

/// Part of the pixels of a rectangle that differ by more than dithering would.
double changed(const Rgb& before, const Rgb& after, glm::ivec2 low, glm::ivec2 high) {
    int all = 0;
    int differ = 0;
    for (int y = std::max(low.y, 0); y < std::min(high.y, before.height); ++y) {
        for (int x = std::max(low.x, 0); x < std::min(high.x, before.width); ++x) {
            const std::uint8_t* a = before.at(x, y);
            const std::uint8_t* b = after.at(x, y);
            ++all;
            differ += std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) > 24 ? 1 : 0;
        }
    }
    return all > 0 ? static_cast<double>(differ) / all : 0.0;
}

TEST_F(WindowSample, DoesWhatTheHandDoes) {
    ASSERT_NO_FATAL_FAILURE(begin({"--size", "400x300", "--scene", "empty", "--radius", "0.08", "--no-panel"}));
    const Shot start = shoot();
    EXPECT_EQ(start.picture.width, kSize.x);
    EXPECT_EQ(start.particles, 0U);
    EXPECT_TRUE(pillarIsSeen(start)) << "the red pillar is not where the camera sees it";

    // Turn: the camera goes as far as the hand, and the picture with it.
    hand().move(200, 150);
    hand().button(kRight, true);
    hand().move(230, 150);
    hand().move(300, 170);
    hand().button(kRight, false);
    const Shot turned = shoot();
    const Orbit expected = dragged(start.camera, {100.0F, 20.0F});
    EXPECT_NEAR(turned.camera.azimuth, expected.azimuth, 0.11F);
    EXPECT_NEAR(turned.camera.elevation, expected.elevation, 0.11F);
    EXPECT_TRUE(pillarIsSeen(turned)) << "the picture did not turn as the camera did";
    EXPECT_GT(changed(start.picture, turned.picture, {0, 0}, kSize), 0.1);

    // Nearer.
    hand().click(kWheelUp);
    hand().click(kWheelUp);
    const Shot nearer = shoot();
    EXPECT_NEAR(nearer.camera.distance, zoomed(turned.camera, 2.0F).distance, 0.011F);
    EXPECT_TRUE(pillarIsSeen(nearer));

    // Pour: the jet falls where the cursor points.
    const glm::vec3 place{-0.9F, 0.0F, -0.3F};
    const glm::vec2 below = pixelOf(nearer.camera, kSize, place);
    const glm::vec2 above = pixelOf(nearer.camera, kSize, place + glm::vec3(0.0F, 0.6F, 0.0F));
    hand().move(static_cast<int>(below.x), static_cast<int>(below.y));
    hand().button(kLeft, true);
    Shot poured;
    ASSERT_TRUE(until([&] { return (poured = shoot()).particles > 60; })) << sample_->text();
    hand().button(kLeft, false);
    const glm::ivec2 low{static_cast<int>(below.x) - 5, static_cast<int>(above.y)};
    const glm::ivec2 high{static_cast<int>(below.x) + 5, static_cast<int>(below.y)};
    EXPECT_GT(changed(nearer.picture, poured.picture, low, high), 0.15) << "no water above the cursor";
    EXPECT_LT(changed(nearer.picture, poured.picture, {0, 0}, {kSize.x, kSize.y / 6}), 0.05) << "water in the sky";

    // Shut: what there is stays.
    const unsigned left = (static_cast<void>(shoot()), shoot().particles);
    EXPECT_GE(left, poured.particles);
    EXPECT_EQ(shoot().particles, left) << "the jet is open still";

    // Pause: two pictures are one, and it is that of the screen.
    hand().key(XK_space);
    const Shot still = shoot();
    const Shot again = shoot();
    EXPECT_TRUE(still.picture == again.picture) << "it flows while it is paused";
    EXPECT_TRUE(hand().look() == again.picture) << "the file does not show what the screen does";

    // The panel comes up, and a click on it changes the view.
    hand().key(XK_h);
    (void)shoot();  // Dear ImGui measures a new window for a frame before it shows it
    const Shot panel = shoot();
    EXPECT_GT(changed(again.picture, panel.picture, {10, 10}, {220, 200}), 0.5);
    EXPECT_EQ(panel.view, 0U);
    hand().move(21, 86);
    (void)shoot();  // each of these in a frame of its own, however slow they are
    hand().button(kLeft, true);
    (void)shoot();
    hand().button(kLeft, false);
    (void)shoot();
    const Shot normals = shoot();
    EXPECT_EQ(normals.view, 2U) << "SLUICE_VIEW_NORMAL";
    EXPECT_EQ(normals.particles, left) << "a click on the panel poured";
    EXPECT_GT(changed(panel.picture, normals.picture, {230, 100}, kSize), 0.02) << "no fluid is shown as normals";

    // Another size, and none at all for a while.
    hand().resize(500, 340);
    ASSERT_TRUE(until([&] { return shoot().picture.width == 500; }));
    EXPECT_EQ(hand().look().width, 500);
    hand().show(false);
    hand().show(true);
    const Shot back = shoot();
    EXPECT_EQ(back.picture.height, 340);
    EXPECT_EQ(back.particles, left);
    if (const char* keep = std::getenv("SLUICE_KEEP_PICTURES"); keep != nullptr) {
        std::filesystem::copy(
            sample_->folder(), keep,
            std::filesystem::copy_options::overwrite_existing | std::filesystem::copy_options::recursive);
    }

    hand().close();
    EXPECT_EQ(waitForEnd(), 0);
    expectNoComplaint();
}

TEST_F(WindowSample, DrawsSoManyFramesInAProcessOfItsOwnWithSamples) {
    sample_ = std::make_unique<Sample>(
        server_->display(), std::vector<std::string>{"--size", "160x120", "--radius", "0.1", "--frames", "4",
                                                     "--samples", "4", "--isolate", "--screenshot", "window_last.png"});
    EXPECT_EQ(waitForEnd(), 0) << sample_->text();
    const Rgb picture = readPng(sample_->folder() / "window_last.png");
    EXPECT_EQ(picture.width, 160);
    EXPECT_EQ(picture.height, 120);
    expectNoComplaint();
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(sample_->folder()), {}), 2)
        << "the log and the picture";
}

TEST(WindowSampleAlone, WithoutADisplayOrWithAWrongCommandLineItSaysSoOnOneLine) {
    const struct {
        std::vector<std::string> arguments;
        int code;
        const char* says;
    } cases[] = {{{}, 4, "no display: "},
                 {{"--size", "12"}, 1, "--size: expected WxH of 64 to 8192 a side, found '12'"},
                 {{"--samples", "3"}, 1, "--samples"},
                 {{"--fountain"}, 1, "--fountain"}};
    for (const auto& [arguments, code, says] : cases) {
        Sample sample("", arguments);
        EXPECT_TRUE(until([&] { return sample.ended().has_value(); }));
        EXPECT_EQ(sample.ended(), code);
        const std::string text = sample.text();
        EXPECT_NE(text.find(says), std::string::npos) << text;
        EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    }
    Sample help("", {"--help"});
    EXPECT_TRUE(until([&] { return help.ended().has_value(); }));
    EXPECT_EQ(help.ended(), 0);
    EXPECT_NE(help.text().find("--screenshot"), std::string::npos);
}

}  // namespace
}  // namespace window::test
