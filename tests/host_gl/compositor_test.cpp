// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "compositor/capture.hpp"
#include "compositor/composite.hpp"
#include "compositor/linear_depth.hpp"
#include "gl_test.hpp"
#include "hostile_state.hpp"
#include "sluice/host_gl/screen.hpp"
#include "sluice/host_gl/state_snapshot.hpp"

namespace sluice::host::test {
namespace {

using ::testing::IsEmpty;

constexpr std::uint32_t kWidth = 37;  // odd, so that a wrong row length shows
constexpr std::uint32_t kHeight = 23;
constexpr float kDepthStep = 1.2e-7F;  // 2 units of 24-bit depth

/// OpenGL perspective with near 0.1 m and far 100 m, off-centre.
constexpr std::array<float, 16> kProjection{1.3F, 0,     0,          0,     0, 1.7F, 0,           0,
                                            0.1F, -0.2F, -1.002002F, -1.0F, 0, 0,    -0.2002002F, 0};

/// A screen on which every pixel has a colour and a depth of its own; a seventh of the depths are 1.
Screen drawnScreen() {
    Result<Screen> created = Screen::create(kWidth, kHeight);
    EXPECT_TRUE(created) << created.error().message();
    Screen screen = std::move(created).value();
    screen.bind();
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    glDepthMask(GL_TRUE);
    glEnable(GL_SCISSOR_TEST);
    for (std::uint32_t y = 0; y < kHeight; ++y) {
        for (std::uint32_t x = 0; x < kWidth; ++x) {
            glScissor(static_cast<GLint>(x), static_cast<GLint>(y), 1, 1);
            glClearColor(unit(random), unit(random), unit(random), unit(random));
            const float depth = unit(random);
            glClearDepth((x + y) % 7 == 0 ? 1.0 : static_cast<double>(depth));
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        }
    }
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return screen;
}

/// Rows from the bottom up, as textures are filled, of what readDepth gives from the top down.
std::vector<float> bottomUp(const Pixels& pixels) {
    std::vector<float> flipped;
    const std::size_t row = std::size_t{pixels.width} * pixels.channels;
    for (std::size_t y = pixels.height; y-- > 0;) {
        const auto from = pixels.values.begin() + static_cast<std::ptrdiff_t>(y * row);
        flipped.insert(flipped.end(), from, from + static_cast<std::ptrdiff_t>(row));
    }
    return flipped;
}

struct Fluid {
    std::vector<float> colour;  // RGBA
    std::vector<float> depth;
};

/// Random fluid: a third without coverage, a quarter of the rest exactly at the screen's own depth, none closer to it
/// than 1e-4 otherwise, so that the test has one right answer everywhere.
Fluid randomFluid(const std::vector<float>& screen_depth) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    Fluid fluid;
    for (const float behind : screen_depth) {
        for (int channel = 0; channel < 3; ++channel) {
            fluid.colour.push_back(std::round(unit(random) * 255.0F) / 255.0F);
        }
        const float kind = unit(random);
        fluid.colour.push_back(kind < 0.33F ? 0.0F : std::round((0.1F + 0.9F * unit(random)) * 255.0F) / 255.0F);
        float depth = unit(random);
        if (std::abs(depth - behind) < 1e-4F) {
            depth = behind > 0.5F ? behind - 0.1F : behind + 0.1F;
        }
        fluid.depth.push_back(unit(random) < 0.25F ? behind : depth);
    }
    return fluid;
}

class CompositorTest : public GlTest {
  protected:
    void SetUp() override {
        GlTest::SetUp();
        Result<Compositor> created = Compositor::create();
        ASSERT_TRUE(created) << created.error().message();
        compositor_ = std::move(created).value();
    }
    Compositor compositor_;
};

void expectModel(const Screen& screen, const std::vector<float>& colour_before, const std::vector<float>& depth_before,
                 const Fluid& fluid) {
    const std::vector<float> colour = bottomUp(readColour(screen, nullptr));
    const std::vector<float> depth = bottomUp(readDepth(screen, nullptr));
    std::size_t drawn = 0;
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) {
        const float a = fluid.colour[4 * i + 3];
        const bool passes = a > 0.0F && fluid.depth[i] <= depth_before[i];
        drawn += passes ? 1 : 0;
        hidden += a > 0.0F && !passes ? 1 : 0;
        ASSERT_NEAR(depth[i], passes ? fluid.depth[i] : depth_before[i], passes ? kDepthStep : 0.0F) << "texel " << i;
        for (std::size_t c = 0; c < 4; ++c) {
            const float over = (c == 3 ? 1.0F : a) * fluid.colour[4 * i + c] + (1.0F - a) * colour_before[4 * i + c];
            ASSERT_NEAR(colour[4 * i + c], passes ? over : colour_before[4 * i + c], passes ? 1.001F / 255.0F : 0.0F)
                << "texel " << i << " channel " << c;
        }
    }
    // Neither case may be absent, or the test has proven half of what it says.
    EXPECT_GT(drawn, depth.size() / 10);
    EXPECT_GT(hidden, depth.size() / 20);
}

TEST_F(CompositorTest, MatchesTheModelTexelByTexelInColourAndDepth) {
    for (const GLenum format : {GLenum{GL_RGBA8}, GLenum{GL_RGBA16F}}) {
        const Screen screen = drawnScreen();
        const std::vector<float> colour = bottomUp(readColour(screen, nullptr));
        const std::vector<float> depth = bottomUp(readDepth(screen, nullptr));
        const Fluid fluid = randomFluid(depth);
        const TestTexture fluid_colour(format, GL_RGBA, GL_FLOAT, kWidth, kHeight, fluid.colour.data());
        const TestTexture fluid_depth(GL_R32F, GL_RED, GL_FLOAT, kWidth, kHeight, fluid.depth.data());
        compositor_.draw(screen.framebuffer(), kWidth, kHeight, fluid_colour.name(), fluid_depth.name());
        expectModel(screen, colour, depth, fluid);
    }
}

TEST_F(CompositorTest, CaptureCopiesColourExactlyAndDepthWithinTwoUnits) {
    const Screen screen = drawnScreen();
    const TestTexture colour(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, kWidth, kHeight, nullptr);
    const TestTexture depth(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, kWidth, kHeight, nullptr);
    captureScreen(screen.framebuffer(), kWidth, kHeight, colour.name(), depth.name());
    // Equal as bytes: the two readers may divide by 255 in different ways.
    const Pixels copied_colour = readTexture(colour.name(), SLUICE_FORMAT_RGBA8, kWidth, kHeight, nullptr);
    const Pixels original_colour = readColour(screen, nullptr);
    ASSERT_EQ(copied_colour.values.size(), original_colour.values.size());
    for (std::size_t i = 0; i < copied_colour.values.size(); ++i) {
        ASSERT_NEAR(copied_colour.values[i], original_colour.values[i], 1e-6F) << "value " << i;
    }
    const Pixels copied = readTexture(depth.name(), SLUICE_FORMAT_D32F, kWidth, kHeight, nullptr);
    const Pixels original = readDepth(screen, nullptr);
    ASSERT_EQ(copied.values.size(), original.values.size());
    for (std::size_t i = 0; i < copied.values.size(); ++i) {
        ASSERT_NEAR(copied.values[i], original.values[i], kDepthStep) << "texel " << i;
    }
}

TEST_F(CompositorTest, LinearDepthMatchesTheFormulaWithinOneMillionthAndIsInfiniteAtDepthOne) {
    const Screen screen = drawnScreen();
    const TestTexture window(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, kWidth, kHeight, nullptr);
    captureScreen(screen.framebuffer(), kWidth, kHeight, 0, window.name());
    const TestTexture linear(GL_R32F, GL_RED, GL_FLOAT, kWidth, kHeight, nullptr);
    const Result<LinearDepthPass> pass = LinearDepthPass::create(kWidth, kHeight);
    ASSERT_TRUE(pass) << pass.error().message();
    pass.value().run(screen.framebuffer(), linear.name(), kProjection);
    const Pixels depth = readTexture(window.name(), SLUICE_FORMAT_D32F, kWidth, kHeight, nullptr);
    const Pixels metres = readTexture(linear.name(), SLUICE_FORMAT_R32F, kWidth, kHeight, nullptr);
    int infinite = 0;
    for (std::size_t i = 0; i < depth.values.size(); ++i) {
        const double d = double{depth.values[i]};
        if (d >= 1.0) {
            ASSERT_TRUE(std::isinf(metres.values[i]) && metres.values[i] > 0.0F) << "texel " << i;
            ++infinite;
            continue;
        }
        // ndc = (P10 z + P14) / (P11 z + P15), solved for -z.
        const double ndc = 2.0 * d - 1.0;
        const double expected = -(double{kProjection[14]} - ndc * double{kProjection[15]}) /
                                (ndc * double{kProjection[11]} - double{kProjection[10]});
        ASSERT_NEAR(double{metres.values[i]} / expected, 1.0, 1e-6) << "texel " << i << " depth " << d;
    }
    EXPECT_GT(infinite, 50);
}

/// Runs `draw` under hostile state and expects the same picture as under clean state and no state left behind.
template <typename Draw>
void expectStateUntouched(const Draw& draw) {
    const Screen clean = drawnScreen();
    draw(clean);
    const Pixels colour = readColour(clean, nullptr);
    const Pixels depth = readDepth(clean, nullptr);

    const Screen screen = drawnScreen();
    const HostileState hostile(screen.framebuffer());
    while (glGetError() != GL_NO_ERROR) {
    }
    const StateSnapshot before = takeStateSnapshot();
    draw(screen);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    EXPECT_THAT(differences(before, takeStateSnapshot()), IsEmpty());

    glReadBuffer(GL_COLOR_ATTACHMENT0);
    EXPECT_EQ(readColour(screen, nullptr).values, colour.values);
    EXPECT_EQ(readDepth(screen, nullptr).values, depth.values);
}

TEST_F(CompositorTest, CompositeDrawsTheSameUnderHostileStateAndLeavesItAsFound) {
    const Fluid fluid = randomFluid(std::vector<float>(std::size_t{kWidth} * kHeight, 0.5F));
    const TestTexture fluid_colour(GL_RGBA8, GL_RGBA, GL_FLOAT, kWidth, kHeight, fluid.colour.data());
    const TestTexture fluid_depth(GL_R32F, GL_RED, GL_FLOAT, kWidth, kHeight, fluid.depth.data());
    expectStateUntouched([&](const Screen& screen) {
        compositor_.draw(screen.framebuffer(), kWidth, kHeight, fluid_colour.name(), fluid_depth.name());
    });
}

TEST_F(CompositorTest, CaptureCopiesTheSameUnderHostileStateAndLeavesItAsFound) {
    const TestTexture colour(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, kWidth, kHeight, nullptr);
    const TestTexture depth(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, kWidth, kHeight, nullptr);
    std::vector<std::vector<float>> colours;
    std::vector<std::vector<float>> depths;
    expectStateUntouched([&](const Screen& screen) {
        captureScreen(screen.framebuffer(), kWidth, kHeight, colour.name(), depth.name());
        colours.push_back(readTexture(colour.name(), SLUICE_FORMAT_RGBA8, kWidth, kHeight, nullptr).values);
        depths.push_back(readTexture(depth.name(), SLUICE_FORMAT_D32F, kWidth, kHeight, nullptr).values);
    });
    ASSERT_EQ(colours.size(), 2U);
    EXPECT_EQ(colours[0], colours[1]);
    EXPECT_EQ(depths[0], depths[1]);
}

TEST_F(CompositorTest, LinearDepthIsTheSameUnderHostileStateAndLeavesItAsFound) {
    const TestTexture linear(GL_R32F, GL_RED, GL_FLOAT, kWidth, kHeight, nullptr);
    const Result<LinearDepthPass> pass = LinearDepthPass::create(kWidth, kHeight);
    ASSERT_TRUE(pass) << pass.error().message();
    std::vector<std::vector<float>> metres;
    expectStateUntouched([&](const Screen& screen) {
        pass.value().run(screen.framebuffer(), linear.name(), kProjection);
        metres.push_back(readTexture(linear.name(), SLUICE_FORMAT_R32F, kWidth, kHeight, nullptr).values);
    });
    ASSERT_EQ(metres.size(), 2U);
    EXPECT_EQ(metres[0], metres[1]);
}

}  // namespace
}  // namespace sluice::host::test
