// SPDX-License-Identifier: MIT
#include "echo_rig.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

namespace sluice::host::test {

namespace {

void drawQuad(float left, float right, const Stamp& stamp) {
    glColor4ub(stamp.colour[0], stamp.colour[1], stamp.colour[2], stamp.colour[3]);
    const float z = 2.0F * stamp.depth - 1.0F;
    glVertex3f(left, -1.0F, z);
    glVertex3f(right, -1.0F, z);
    glVertex3f(right, 1.0F, z);
    glVertex3f(left, 1.0F, z);
}

/// The column from which the right half begins: pixel centres right of clip x = 0.
std::uint32_t middle(std::uint32_t width) {
    return width / 2;
}

}  // namespace

Stamp stampOf(std::uint64_t frame, int half) {
    // Odd multipliers walk all 256 values; the steps are far above rounding in RGBA16F and 24-bit depth.
    const std::uint64_t seed = 2 * frame + static_cast<std::uint64_t>(half);
    Stamp stamp{};
    stamp.colour = {static_cast<std::uint8_t>(seed * 37), static_cast<std::uint8_t>(seed * 91 + 5),
                    static_cast<std::uint8_t>(seed * 153 + 9), 255};
    stamp.depth = 0.05F + 0.9F * static_cast<float>((seed * 389) % 1000) / 1000.0F;
    return stamp;
}

void drawStamp(const Screen& screen, std::uint64_t frame, int layers) {
    screen.bind();
    glDepthMask(GL_TRUE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDisable(GL_DITHER);
    glBegin(GL_QUADS);
    for (int i = 0; i < layers; ++i) {
        drawQuad(-1.0F, 1.0F, stampOf(frame * 31 + static_cast<std::uint64_t>(i) + 100, i % 2));
    }
    // Clip x = 0 lies inside the middle column of an odd width, whose centre then belongs to the right half.
    const auto width = static_cast<float>(screen.width());
    const float edge = 2.0F * static_cast<float>(middle(screen.width())) / width - 1.0F;
    drawQuad(-1.0F, edge, stampOf(frame, 0));
    drawQuad(edge, 1.0F, stampOf(frame, 1));
    glEnd();
    glDisable(GL_DEPTH_TEST);
}

namespace {

bool holdsColour(const Stamp& stamp, const float* texel) {
    for (std::size_t c = 0; c < 4; ++c) {
        if (std::abs(texel[c] - static_cast<float>(stamp.colour.at(c)) / 255.0F) >= 0.5F / 255.0F) {
            return false;
        }
    }
    return true;
}

bool holdsDepth(const Stamp& stamp, float depth) {
    // Two units of 24-bit depth: one for the rasteriser, one for the copy to float.
    return std::abs(depth - stamp.depth) < 1.8e-7F;
}

}  // namespace

Verdict inspect(const FluidHost& host, std::uint64_t frame) {
    return inspect(host.info(), host.texture(SLUICE_IMAGE_FLUID_COLOUR), host.texture(SLUICE_IMAGE_FLUID_DEPTH), frame);
}

Verdict inspect(const SluiceRendererInfo& info, std::uint32_t colour_texture, std::uint32_t depth_texture,
                std::uint64_t frame) {
    const Pixels colour =
        readTexture(colour_texture, static_cast<SluiceFormat>(info.formats[SLUICE_IMAGE_FLUID_COLOUR]), info.width,
                    info.height, nullptr);
    const Pixels depth = readTexture(depth_texture, static_cast<SluiceFormat>(info.formats[SLUICE_IMAGE_FLUID_DEPTH]),
                                     info.width, info.height, nullptr);
    Verdict verdict;
    verdict.texels = depth.values.size();
    for (std::size_t i = 0; i < depth.values.size(); ++i) {
        const int half = i % info.width < middle(info.width) ? 0 : 1;
        const Stamp stamp = stampOf(frame, half);
        const float* texel = &colour.values[4 * i];
        const bool colour_right = holdsColour(stamp, texel);
        const bool depth_right = holdsDepth(stamp, depth.values[i]);
        verdict.wrong_colour += colour_right ? 0U : 1U;
        verdict.wrong_depth += depth_right ? 0U : 1U;
        bool stale = false;
        for (std::uint64_t earlier = 1; earlier < frame && !stale && !(colour_right && depth_right); ++earlier) {
            const Stamp old = stampOf(earlier, half);
            stale = holdsColour(old, texel) && holdsDepth(old, depth.values[i]);
        }
        verdict.stale += stale ? 1U : 0U;
    }
    return verdict;
}

FrameInput echoInput() {
    FrameInput input;
    for (const std::size_t i : {std::size_t{0}, std::size_t{5}, std::size_t{10}, std::size_t{15}}) {
        input.camera.view[i] = 1.0F;
    }
    // 90 degrees, near 0.1 m, far 100 m.
    input.camera.projection[0] = 1.0F;
    input.camera.projection[5] = 1.0F;
    input.camera.projection[10] = -1.002002F;
    input.camera.projection[11] = -1.0F;
    input.camera.projection[14] = -0.2002002F;
    input.camera.near_plane = 0.1F;
    input.camera.far_plane = 100.0F;
    input.sky.to_sun[1] = 1.0F;
    input.fluid.index_of_refraction = 1.33F;
    input.fluid.specular_power = 100.0F;
    input.fluid.splat_radius = 1.5F;
    input.fluid.thickness_scale = 0.5F;
    input.fluid.view = SLUICE_VIEW_ECHO;
    return input;
}

void EchoTest::SetUp() {
    Result<GlContext> context = GlContext::create();
    ASSERT_TRUE(context) << context.error().message();
    context_.emplace(std::move(context).value());
    ASSERT_TRUE(context_->makeCurrent());
    Result<PluginLibrary> library = PluginLibrary::load(SLUICE_REAL_RENDERER);
    ASSERT_TRUE(library) << library.error().message();
    library_.emplace(std::move(library).value());
}

void EchoTest::TearDown() {
    host_.reset();
    screen_.reset();
    EXPECT_TRUE(complaints_.empty()) << complaints_.front();
}

FluidHostConfig EchoTest::config() const {
    FluidHostConfig config;
    config.width = kEchoWidth;
    config.height = kEchoHeight;
    // Most of these tests are about what one renderer does; recovery_test is about the next.
    config.recovery.attempts = 0;
    config.call_alarm_ns = 0;
    return config;
}

void EchoTest::makeHost(const FluidHostConfig& config) {
    FluidHostConfig logged = config;
    logged.log = [this](SluiceLogLevel level, std::string_view text) {
        if (level >= SLUICE_LOG_WARNING) {
            complaints_.emplace_back(text);
        }
    };
    Result<std::unique_ptr<FluidHost>> host = FluidHost::create(*library_, logged);
    ASSERT_TRUE(host) << host.error().message();
    host_ = std::move(host).value();
}

void EchoTest::makeScreen(std::uint32_t width, std::uint32_t height) {
    Result<Screen> screen = Screen::create(width, height);
    ASSERT_TRUE(screen) << screen.error().message();
    screen_.emplace(std::move(screen).value());
}

void EchoTest::frameIsClean() {
    const std::uint64_t frame = host_->frame() + 1;
    drawStamp(*screen_, frame, 4);
    const Status submitted = host_->submit(*screen_, echoInput());
    ASSERT_TRUE(submitted) << submitted.error().message();
    const Status composited = host_->composite(*screen_);
    ASSERT_TRUE(composited) << composited.error().message();
    EXPECT_TRUE(inspect(*host_, frame).clean());
}

}  // namespace sluice::host::test
