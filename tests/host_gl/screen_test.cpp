// SPDX-License-Identifier: MIT
#include "sluice/host_gl/screen.hpp"

#include <gmock/gmock.h>

#include <vector>

#include "gl_test.hpp"
#include "sluice/format.hpp"
#include "sluice/host_gl/state_snapshot.hpp"

namespace sluice::host::test {
namespace {

using ScreenTest = GlTest;
using Readback = GlTest;
using ::testing::HasSubstr;

Screen makeScreen(std::uint32_t width, std::uint32_t height) {
    auto screen = Screen::create(width, height);
    EXPECT_TRUE(screen.ok()) << screen.error().message();
    return std::move(screen).value();
}

float at(const Pixels& pixels, std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
    return pixels.values.at((std::size_t{y} * pixels.width + x) * pixels.channels + channel);
}

TEST_F(ScreenTest, HasTheBitsOfAnEngineOf2004) {
    const Screen screen = makeScreen(67, 43);
    screen.bind();
    const auto bits = [](GLenum name) {
        GLint value = 0;
        glGetIntegerv(name, &value);
        return value;
    };
    EXPECT_EQ(bits(GL_RED_BITS), 8);
    EXPECT_EQ(bits(GL_ALPHA_BITS), 8);
    EXPECT_EQ(bits(GL_DEPTH_BITS), 24);
    EXPECT_EQ(bits(GL_STENCIL_BITS), 8);
    std::array<GLint, 4> viewport{};
    glGetIntegerv(GL_VIEWPORT, viewport.data());
    EXPECT_EQ(viewport, (std::array<GLint, 4>{0, 0, 67, 43}));
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST_F(ScreenTest, AbsurdSizesAreErrorsThatNameTheLimit) {
    const auto zero = Screen::create(0, 720);
    ASSERT_FALSE(zero.ok());
    EXPECT_EQ(zero.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(zero.error().message(), HasSubstr("0x720"));
    for (const std::uint32_t size : {1'000'000U, 0xFFFFFFFFU}) {
        const auto huge = Screen::create(64, size);
        ASSERT_FALSE(huge.ok());
        EXPECT_THAT(huge.error().message(), HasSubstr("GL_MAX_"));
        EXPECT_THAT(huge.error().message(), HasSubstr(std::to_string(size)));
    }
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST_F(ScreenTest, CreationLeavesStateAlone) {
    const StateSnapshot before = takeStateSnapshot();
    const Screen screen = makeScreen(32, 32);
    EXPECT_THAT(differences(before, takeStateSnapshot()), ::testing::IsEmpty());
}

TEST_F(ScreenTest, MovingKeepsOneOwner) {
    Screen first = makeScreen(8, 8);
    const GLuint name = first.framebuffer();
    Screen second = std::move(first);
    EXPECT_EQ(second.framebuffer(), name);
    second.bind();
    EXPECT_EQ(glIsFramebuffer(name), GL_TRUE);
    { const Screen last = std::move(second); }
    EXPECT_EQ(glIsFramebuffer(name), GL_FALSE);
}

/// Clears to black, and a corner of the picture's top left to `colour` and near depth.
void drawTopLeft(const Screen& screen) {
    screen.bind();
    glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, static_cast<GLint>(screen.height()) - 3, 5, 3);
    glClearColor(1.0F, 0.5F, 0.25F, 0.0F);
    glClearDepth(0.25);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
}

TEST_F(Readback, RowsComeFromTheTopDown) {
    const Screen screen = makeScreen(17, 11);
    drawTopLeft(screen);
    const Pixels colour = readColour(screen, nullptr);
    const Pixels depth = readDepth(screen, nullptr);
    ASSERT_EQ(colour.channels, 4U);
    ASSERT_EQ(depth.channels, 1U);
    ASSERT_EQ(colour.values.size(), 17U * 11U * 4U);
    for (std::uint32_t y = 0; y < 11; ++y) {
        for (std::uint32_t x = 0; x < 17; ++x) {
            const bool corner = x < 5 && y < 3;
            ASSERT_EQ(at(colour, x, y, 0), corner ? 1.0F : 0.0F) << x << "," << y;
            ASSERT_NEAR(at(colour, x, y, 1), corner ? 0.5F : 0.0F, 1.0F / 255.0F) << x << "," << y;
            ASSERT_EQ(at(colour, x, y, 3), corner ? 0.0F : 1.0F) << x << "," << y;
            ASSERT_NEAR(at(depth, x, y, 0), corner ? 0.25F : 1.0F, 1.0F / 16777215.0F) << x << "," << y;
        }
    }
}

TEST_F(Readback, IsIndependentOfTheCallersStateAndKeepsIt) {
    const Screen screen = makeScreen(17, 11);
    drawTopLeft(screen);
    const Pixels plain = readColour(screen, nullptr);
    const Pixels plain_depth = readDepth(screen, nullptr);
    glReadBuffer(GL_NONE);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glPixelTransferf(GL_RED_SCALE, 0.5F);
    glPixelTransferf(GL_DEPTH_BIAS, 0.25F);
    glPixelStorei(GL_PACK_ROW_LENGTH, 100);
    glPixelStorei(GL_PACK_ALIGNMENT, 8);
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    const StateSnapshot before = takeStateSnapshot();
    EXPECT_EQ(readColour(screen, nullptr).values, plain.values);
    EXPECT_EQ(readDepth(screen, nullptr).values, plain_depth.values);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    EXPECT_THAT(differences(before, takeStateSnapshot()), ::testing::IsEmpty());
    screen.bind();
    GLint read_buffer = GL_BACK;
    glGetIntegerv(GL_READ_BUFFER, &read_buffer);
    EXPECT_EQ(read_buffer, GL_NONE) << "the screen's own read buffer was not put back";
    glDeleteBuffers(1, &buffer);
}

TEST_F(Readback, EveryCopyIsTracedWithItsBytes) {
    const Screen screen = makeScreen(16, 8);
    Trace trace(16);
    (void)readColour(screen, &trace);
    (void)readDepth(screen, &trace);
    const TestTexture texture(GL_RGBA32F, GL_RGBA, GL_FLOAT, 4, 2, nullptr);
    (void)readTexture(texture.name(), SLUICE_FORMAT_RGBA32F, 4, 2, &trace);
    const TraceTotals sum = totals(trace.drain());
    EXPECT_EQ(sum.count[SLUICE_TRACE_CPU_COPY], 3U);
    EXPECT_EQ(sum.bytes[SLUICE_TRACE_CPU_COPY], 16U * 8U * 4U * 2U + 4U * 2U * 16U);
}

TEST_F(Readback, TexturesOfEveryFormatKeepTheirChannels) {
    for (const FormatInfo& format : formatTable()) {
        SCOPED_TRACE(format.name);
        // 3x2 texels of raw transfer bytes; row 0 is the bottom. 0x5C of every byte is finite in all formats.
        std::vector<std::uint8_t> raw(std::size_t{3} * 2 * format.bytes_per_texel, 0);
        std::fill(raw.begin() + std::ptrdiff_t{3} * format.bytes_per_texel, raw.end(), std::uint8_t{0x5C});
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        const TestTexture texture(format.gl_internal, format.gl_transfer_format, format.gl_transfer_type, 3, 2,
                                  raw.data());
        const Pixels pixels = readTexture(texture.name(), format.format, 3, 2, nullptr);
        EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
        ASSERT_EQ(pixels.channels, format.channels);
        ASSERT_EQ(pixels.values.size(), std::size_t{3} * 2 * format.channels);
        const std::size_t row = std::size_t{3} * format.channels;
        for (std::size_t i = 0; i < row; ++i) {
            EXPECT_GT(pixels.values[i], 0.0F) << "top row, value " << i;
            EXPECT_EQ(pixels.values[row + i], 0.0F) << "bottom row, value " << i;
        }
    }
}

TEST_F(Readback, KnownTexelsHaveTheirValues) {
    const std::array<std::uint32_t, 1> integer{123456};
    const TestTexture r32ui(GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 1, 1, integer.data());
    EXPECT_EQ(readTexture(r32ui.name(), SLUICE_FORMAT_R32UI, 1, 1, nullptr).values.at(0), 123456.0F);
    const std::array<std::uint32_t, 1> packed{0x80000007U};
    const TestTexture d24s8(GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, 1, 1, packed.data());
    const Pixels depth = readTexture(d24s8.name(), SLUICE_FORMAT_D24S8, 1, 1, nullptr);
    EXPECT_NEAR(depth.values.at(0), 8388608.0F / 16777215.0F, 1e-7F);
    EXPECT_EQ(depth.values.at(1), 7.0F);
    const std::array<float, 4> wide{-2.5F, 1e6F, 0.125F, 3.0F};
    const TestTexture rgba32f(GL_RGBA32F, GL_RGBA, GL_FLOAT, 1, 1, wide.data());
    EXPECT_THAT(readTexture(rgba32f.name(), SLUICE_FORMAT_RGBA32F, 1, 1, nullptr).values,
                ::testing::ElementsAreArray(wide));
}

}  // namespace
}  // namespace sluice::host::test
