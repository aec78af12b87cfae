// SPDX-License-Identifier: MIT
// libsluice.so in contexts that it did not make.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "fluid.hpp"
#include "hostile_state.hpp"
#include "sluice/host_gl/screen.hpp"
#include "sluice/host_gl/state_snapshot.hpp"
#include "sluice/ledger/recording.hpp"

extern "C" {
int c99_uses_the_library(void);
int c99_loads_the_library(const char* path, char* why, std::size_t size);
}

namespace sluice::test {
namespace {

/// Whose command line is "sluice-renderer --host PID PLUGIN".
pid_t rendererOfThisProcess() {
    const std::string ours = "--host" + std::string(1, '\0') + std::to_string(::getpid()) + std::string(1, '\0');
    for (const auto& process : std::filesystem::directory_iterator("/proc")) {
        std::ifstream file(process.path() / "cmdline", std::ios::binary);
        const std::string line{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
        if (line.find("sluice-renderer") != std::string::npos && line.find(ours) != std::string::npos) {
            return std::stoi(process.path().filename());
        }
    }
    return 0;
}

/// Of whichever thread started them.
std::vector<pid_t> childrenOfThisProcess() {
    std::vector<pid_t> found;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        std::ifstream list(task.path() / "children");
        for (pid_t child = 0; list >> child;) {
            found.push_back(child);
        }
    }
    return found;
}

class InContext : public ::testing::TestWithParam<Version> {};

TEST_P(InContext, FluidIsBehindTheWallAndNoStateIsLeft) {
    const EglCaller caller(GetParam());
    ASSERT_TRUE(caller.ok()) << "no such context";
    const Buffers screen(kWidth, kHeight, {});
    Log log;
    const host::StateSnapshot before = host::takeStateSnapshot();
    Fluid fluid = make(options(log, SLUICE_PROCESS_SAME));
    ASSERT_NE(fluid, nullptr);
    ASSERT_EQ(pour(fluid.get()), SLUICE_OK) << sluice_last_error(fluid.get());
    EXPECT_EQ(host::differences(before, host::takeStateSnapshot()), std::vector<std::string>{});
    drawRoom();
    const host::StateSnapshot drawing = host::takeStateSnapshot();
    const Seen seen = lookAt(fluid.get(), screen.name());
    EXPECT_EQ(host::differences(drawing, host::takeStateSnapshot()), std::vector<std::string>{});
    EXPECT_EQ(seen.wall, 0);
    EXPECT_GT(seen.open, 300);
    const host::StateSnapshot resizing = host::takeStateSnapshot();
    EXPECT_EQ(sluice_resize(fluid.get(), kWidth / 2, kHeight / 2), SLUICE_OK) << sluice_last_error(fluid.get());
    fluid.reset();
    EXPECT_EQ(host::differences(resizing, host::takeStateSnapshot()), std::vector<std::string>{});
    EXPECT_EQ(log.lines, std::vector<std::string>{});
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

INSTANTIATE_TEST_SUITE_P(Api, InContext,
                         ::testing::Values(Version{1, 5, false}, Version{2, 1, false}, Version{3, 1, false},
                                           Version{3, 2, true}, Version{4, 5, true}),
                         [](const auto& made) {
                             return "Gl" + std::to_string(made.param.major) + std::to_string(made.param.minor) +
                                    (made.param.core ? "Core" : "Compatibility");
                         });

TEST(Api, IsC99AndTakesWrongArguments) {
    EXPECT_EQ(c99_uses_the_library(), 0);
}

TEST(Api, IsLoadedByHand) {
    std::array<char, 256> why{};
    EXPECT_EQ(c99_loads_the_library(SLUICE_LIBRARY, why.data(), why.size()), 0) << why.data();
}

TEST(Api, WithoutAContextSaysSo) {
    Log log;
    const SluiceOptions asked = options(log, SLUICE_PROCESS_SAME);
    Sluice* fluid = nullptr;
    EXPECT_EQ(sluice_create(&asked, &fluid), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(fluid, nullptr);
    ASSERT_EQ(log.lines.size(), 1U);
    EXPECT_NE(log.lines[0].find("no EGL or GLX context is current"), std::string::npos) << log.lines[0];
    EXPECT_EQ(log.lines[0], sluice_last_error(nullptr));
}

std::vector<std::uint8_t> pictureIn(const Formats& formats, bool encode) {
    const EglCaller caller({4, 5, false});
    const Buffers screen(kWidth, kHeight, formats);
    Log log;
    const Fluid fluid = make(options(log, SLUICE_PROCESS_SAME));
    EXPECT_EQ(pour(fluid.get()), SLUICE_OK);
    return firstFrame(fluid.get(), screen.name(), encode);
}

std::vector<std::uint8_t> pictureIn(const Window& window, bool encode) {
    const EglCaller caller({4, 5, false}, window);
    EXPECT_TRUE(caller.ok()) << "no such window";
    Log log;
    const Fluid fluid = make(options(log, SLUICE_PROCESS_SAME, 0, 0));
    EXPECT_EQ(pour(fluid.get()), SLUICE_OK);
    return firstFrame(fluid.get(), 0, encode);
}

TEST(Api, ThePictureIsTheSameInEveryFramebuffer) {
    const auto plain = pictureIn(Formats{}, false);
    EXPECT_EQ(pictureIn(Formats{GL_RGBA8, GL_DEPTH24_STENCIL8, 4}, false), plain) << "four samples";
    EXPECT_EQ(pictureIn(Formats{GL_RGBA8, GL_DEPTH_COMPONENT32F, 0}, false), plain) << "float depth";
    EXPECT_EQ(pictureIn(Formats{GL_SRGB8_ALPHA8, GL_DEPTH_COMPONENT24, 0}, false), plain) << "sRGB, off";
    EXPECT_EQ(pictureIn(Formats{GL_SRGB8_ALPHA8, GL_DEPTH_COMPONENT24, 0}, true), plain) << "sRGB, on";
    EXPECT_EQ(pictureIn(Formats{GL_SRGB8_ALPHA8, GL_DEPTH24_STENCIL8, 4}, true), plain) << "sRGB, on, four samples";
    EXPECT_EQ(pictureIn(Window{}, false), plain) << "a window";
    EXPECT_EQ(pictureIn(Window{kWidth, kHeight, 4, false}, false), plain) << "a window of four samples";
    EXPECT_EQ(pictureIn(Window{kWidth, kHeight, 0, true}, true), plain) << "a window in sRGB";
}

TEST(Api, ThePictureIsTheSameWithAHostileState) {
    const EglCaller caller({4, 5, false});
    const Buffers screen(kWidth, kHeight, {});
    Log log;
    const Fluid fluid = make(options(log, SLUICE_PROCESS_SAME));
    ASSERT_EQ(pour(fluid.get()), SLUICE_OK);
    const host::Screen seen = host::Screen::borrowed(screen.name(), kWidth, kHeight);
    static_cast<void>(firstFrame(fluid.get(), screen.name()));
    const host::Pixels plain = host::readColour(seen, nullptr);
    const Camera eye = camera();
    ASSERT_EQ(sluice_begin_frame(fluid.get(), eye.view.data(), eye.projection.data(), 1.0), SLUICE_OK);
    drawRoom();
    {
        const host::test::HostileState hostile(screen.name());
        const host::StateSnapshot before = host::takeStateSnapshot();
        EXPECT_EQ(sluice_end_frame(fluid.get()), SLUICE_OK) << sluice_last_error(fluid.get());
        EXPECT_EQ(host::differences(before, host::takeStateSnapshot()), std::vector<std::string>{});
    }
    EXPECT_EQ(host::readColour(seen, nullptr).values, plain.values);
    ASSERT_EQ(log.lines.size(), 1U) << "of the depth range, which was another one when the frame began";
    EXPECT_NE(log.lines[0].find("glDepthRange is 0.25 to 0.5 at sluice_end_frame and was 0 to 1"), std::string::npos)
        << log.lines[0];
}

TEST(Api, TheWindowsSizeIsFollowed) {
    EglCaller caller({2, 1, false}, Window{});
    Log log;
    const Fluid fluid = make(options(log, SLUICE_PROCESS_SAME, 0, 0));
    ASSERT_EQ(pour(fluid.get()), SLUICE_OK);
    for (const GLsizei width : {96, 150, 60}) {
        caller.resize(width, kHeight);
        glViewport(0, 0, 2 * width, 2 * kHeight);  // what the engine draws with is its own affair
        ASSERT_EQ(frame(fluid.get(), 1.0, width, kHeight), SLUICE_OK) << sluice_last_error(fluid.get());
        const SluiceStatistics statistics = statisticsOf(fluid.get());
        EXPECT_EQ(statistics.width, static_cast<std::uint32_t>(width));
        EXPECT_EQ(statistics.height, static_cast<std::uint32_t>(kHeight));
        EXPECT_EQ(statistics.renderers, 1U);
    }
}

TEST(Api, AFramebufferThatIsTooSmallOrHasNoDepthIsLeftAlone) {
    const EglCaller caller({2, 1, false});
    Log log;
    const Fluid fluid = make(options(log, SLUICE_PROCESS_SAME));
    ASSERT_EQ(pour(fluid.get()), SLUICE_OK);
    const Buffers small(kWidth / 2, kHeight, {});
    drawRoom(kWidth / 2);
    const auto before = pixels(small.name(), kWidth / 2);
    for (int repeated = 0; repeated < 3; ++repeated) {
        EXPECT_EQ(frame(fluid.get(), 1.0, kWidth / 2), SLUICE_ERROR_INVALID_ARGUMENT);
    }
    EXPECT_EQ(pixels(small.name(), kWidth / 2), before);
    ASSERT_EQ(log.lines.size(), 1U) << "a failure is told once";
    EXPECT_NE(log.lines[0].find("48x64"), std::string::npos) << log.lines[0];
    const Buffers flat(kWidth, kHeight, {});
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, 0);
    EXPECT_EQ(frame(fluid.get(), 1.0), SLUICE_ERROR_UNSUPPORTED);
    EXPECT_NE(std::string(sluice_last_error(fluid.get())).find("has no depth"), std::string::npos);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    const Buffers right(kWidth, kHeight, {});
    EXPECT_EQ(frame(fluid.get(), 1.0), SLUICE_OK) << sluice_last_error(fluid.get());
}

TEST(Api, AnotherContextInTheMiddleOfEverything) {
    Log log;
    Fluid fluid;
    {
        EglCaller first({2, 1, false}, Window{});
        fluid = make(options(log, SLUICE_PROCESS_SAME, 0, 0));
        ASSERT_EQ(pour(fluid.get()), SLUICE_OK);
        ASSERT_EQ(frame(fluid.get(), 1.0), SLUICE_OK) << sluice_last_error(fluid.get());
        const Camera eye = camera();
        ASSERT_EQ(sluice_begin_frame(fluid.get(), eye.view.data(), eye.projection.data(), 1.1), SLUICE_OK);
        first.destroyContext();
        EXPECT_EQ(sluice_end_frame(fluid.get()), SLUICE_ERROR_INVALID_ARGUMENT);
        EXPECT_EQ(sluice_begin_frame(fluid.get(), eye.view.data(), eye.projection.data(), 1.2),
                  SLUICE_ERROR_INVALID_ARGUMENT);
    }
    const EglCaller second({4, 5, true}, Window{});
    // Names that the Sluice had in the first context are the engine's in this one.
    std::array<GLuint, 64> textures{};
    glGenTextures(64, textures.data());
    for (const GLuint name : textures) {
        glBindTexture(GL_TEXTURE_2D, name);
    }
    const Seen seen = lookAt(fluid.get(), 0);
    EXPECT_EQ(seen.wall, 0);
    EXPECT_GT(seen.open, 300);
    for (const GLuint name : textures) {
        EXPECT_EQ(glIsTexture(name), GL_TRUE);
    }
    const SluiceStatistics statistics = statisticsOf(fluid.get());
    EXPECT_EQ(statistics.contexts, 2U);
    EXPECT_EQ(statistics.frames, 2U);
    EXPECT_EQ(statistics.frames_without, 1U);
}

TEST(Api, ADestroyWithoutItsContextAsksNothingOfGl) {
    Log log;
    Fluid fluid;
    {
        const EglCaller caller({}, Window{});
        fluid = make(options(log, SLUICE_PROCESS_SAME, 0, 0));
        ASSERT_EQ(pour(fluid.get()), SLUICE_OK);
        ASSERT_EQ(frame(fluid.get(), 1.0), SLUICE_OK);
    }
    fluid.reset();
    EXPECT_EQ(log.lines, std::vector<std::string>{});
}

TEST(Api, SwitchedOffItCostsAndChangesNothing) {
    const EglCaller caller({});
    const Buffers screen(kWidth, kHeight, {});
    Log log;
    const Fluid fluid = make(options(log, SLUICE_PROCESS_SAME));
    drawRoom();
    const auto before = pixels(screen.name());
    EXPECT_EQ(frame(fluid.get(), 1.0), SLUICE_OK) << "without water";
    ASSERT_EQ(pour(fluid.get()), SLUICE_OK);
    ASSERT_EQ(sluice_set_enabled(fluid.get(), 0), SLUICE_OK);
    EXPECT_EQ(frame(fluid.get(), 1.1), SLUICE_OK);
    EXPECT_EQ(pixels(screen.name()), before);
    ASSERT_EQ(sluice_set_enabled(fluid.get(), 1), SLUICE_OK);
    EXPECT_EQ(frame(fluid.get(), 1.2), SLUICE_OK);
    EXPECT_NE(pixels(screen.name()), before);
}

TEST(Api, AnEmitterPoursAndABodyIsWhereItIsDriven) {
    const EglCaller caller({});
    const Buffers screen(kWidth, kHeight, {});
    Log log;
    const Fluid fluid = make(options(log, SLUICE_PROCESS_SAME));
    SluiceEmitter tap{};
    tap.centre[1] = 1.5F;
    tap.direction[1] = -1.0F;
    tap.width = 0.4F;
    tap.height = 0.4F;
    tap.speed = 2.0F;
    SluiceBody ball{};
    ball.shape = SLUICE_SOLID_SPHERE;
    ball.motion = SLUICE_BODY_DRIVEN;
    ball.half[0] = 0.2F;
    ball.half[1] = 0.2F;
    ball.half[2] = 0.2F;
    ball.centre[1] = 0.3F;
    SluiceWater water{};
    sluice_water_defaults(&water, sizeof(water));
    water.radius = 0.08F;
    water.emitter_count = 1;
    water.emitters = &tap;
    water.max_particles = 2000;
    water.body_count = 1;
    water.bodies = &ball;
    ASSERT_EQ(sluice_set_water(fluid.get(), &water), SLUICE_OK) << sluice_last_error(fluid.get());
    SluiceBodies bodies{};
    bodies.struct_size = sizeof(bodies);
    EXPECT_EQ(sluice_bodies(fluid.get(), &bodies), SLUICE_NOT_READY);
    for (int k = 0; k < 6; ++k) {
        SluiceBodyTarget target{};
        target.struct_size = sizeof(target);
        target.centre[0] = 0.05F * static_cast<float>(k);
        target.centre[1] = 0.3F;
        target.turn[3] = 1.0F;
        ASSERT_EQ(sluice_set_body(fluid.get(), 0, &target), SLUICE_OK) << sluice_last_error(fluid.get());
        ASSERT_EQ(frame(fluid.get(), 1.0 + 0.04 * k), SLUICE_OK) << sluice_last_error(fluid.get());
    }
    ASSERT_EQ(sluice_bodies(fluid.get(), &bodies), SLUICE_OK) << sluice_last_error(fluid.get());
    ASSERT_EQ(bodies.count, 1U);
    EXPECT_NEAR(bodies.bodies[0].centre[0], 0.25F, 1e-3F);
    const SluiceStatistics statistics = statisticsOf(fluid.get());
    EXPECT_GT(statistics.particles, 4U);
    EXPECT_EQ(log.lines, std::vector<std::string>{});
}

TEST(Api, ALedgersLogHasEveryFrameAndNothingToFind) {
    const EglCaller caller({});
    const Buffers screen(kWidth, kHeight, {});
    const std::string path = ::testing::TempDir() + "api_test_ledger.log";
    Log log;
    SluiceOptions asked = options(log, SLUICE_PROCESS_SAME);
    asked.ledger_log = path.c_str();
    Fluid fluid = make(asked);
    ASSERT_EQ(pour(fluid.get()), SLUICE_OK);
    EXPECT_EQ(frame(fluid.get(), 1.0), SLUICE_OK);
    EXPECT_EQ(frame(fluid.get(), 1.1), SLUICE_OK);
    fluid.reset();
    const Result<ledger::Recording> recording = ledger::loadRecording(path);
    ASSERT_TRUE(recording) << recording.error().message();
    EXPECT_GT(recording.value().events.size(), 10U);
    EXPECT_EQ(log.lines, std::vector<std::string>{});
    std::filesystem::remove(path);
}

TEST(Api, AFlowIsChangedWhileItFlowsAndKeptInAnotherContext) {
    Log log;
    Fluid fluid;
    SluiceEmitter tap{};
    tap.centre[1] = 1.5F;
    tap.direction[1] = -1.0F;
    tap.width = 0.4F;
    tap.height = 0.4F;
    tap.speed = 2.0F;
    SluiceWater water{};
    sluice_water_defaults(&water, sizeof(water));
    water.radius = 0.08F;
    water.emitter_count = 1;
    water.emitters = &tap;
    SluiceFlow flow{};
    sluice_flow_of(&water, &flow, sizeof(flow));
    ASSERT_EQ(flow.emitter_count, 1U);
    EXPECT_EQ(flow.emitters[0].speed, 2.0F);
    EXPECT_EQ(flow.iterations, water.iterations);
    double time = 1.0;
    const auto particlesAfter = [&](int frames) {
        for (int k = 0; k < frames; ++k) {
            EXPECT_EQ(frame(fluid.get(), time += 0.04), SLUICE_OK) << sluice_last_error(fluid.get());
        }
        return statisticsOf(fluid.get()).particles;
    };
    {
        const EglCaller first({});
        const Buffers screen(kWidth, kHeight, {});
        fluid = make(options(log, SLUICE_PROCESS_OWN));
        EXPECT_EQ(sluice_set_flow(fluid.get(), &flow), SLUICE_ERROR_INVALID_ARGUMENT) << "there is no fluid yet";
        log.lines.clear();
        ASSERT_EQ(sluice_set_water(fluid.get(), &water), SLUICE_OK) << sluice_last_error(fluid.get());
        EXPECT_GT(particlesAfter(4), 4U);
        flow.emitter_count = 0;
        ASSERT_EQ(sluice_set_flow(fluid.get(), &flow), SLUICE_OK) << sluice_last_error(fluid.get());
        const std::uint32_t shut = particlesAfter(2);
        EXPECT_EQ(particlesAfter(2), shut);
        const SluiceStatistics statistics = statisticsOf(fluid.get());
        EXPECT_EQ(statistics.cpu_copy_bytes + statistics.upload_bytes, 0U);
        EXPECT_GT(statistics.pass_count, 3U);
        EXPECT_GT(statistics.last_simulation_seconds, 0.0);
        EXPECT_LE(statistics.wait_seconds, statistics.end_frame_seconds);
        SluiceFlow wrong = flow;
        wrong.viscosity = -1.0F;
        EXPECT_EQ(sluice_set_flow(fluid.get(), &wrong), SLUICE_ERROR_INVALID_ARGUMENT);
        log.lines.clear();
    }
    const EglCaller second({});
    const Buffers screen(kWidth, kHeight, {});
    EXPECT_EQ(particlesAfter(3), 0U) << "the jet is open again";
    ASSERT_EQ(log.lines.size(), 1U);
    EXPECT_NE(log.lines[0].find("another GL context is current"), std::string::npos) << log.lines[0];
}

TEST(Api, SeveralFluidsFlowAndOneChangesOrTheyAreRefusedByName) {
    const EglCaller caller({});
    const Buffers screen(kWidth, kHeight, {});
    Log log;
    const Fluid fluid = make(options(log, SLUICE_PROCESS_OWN));
    SluiceWater water{};
    sluice_water_defaults(&water, sizeof(water));
    water.radius = 0.1F;
    std::array<SluiceFluidKind, 2> kinds{{{1.0F, 0.02F, 0.0F, 0.0F, {}}, {0.25F, 0.1F, 0.0F, 0.0F, {}}}};
    std::array<SluiceBlock, 2> blocks{};
    for (std::size_t i = 0; i < 2; ++i) {
        blocks.at(i) = {
            {-0.5F, 0.5F * static_cast<float>(i), -0.5F}, {0.5F, 0.5F * static_cast<float>(i + 1), 0.5F}, {}, 0, {}};
    }
    blocks[0].fluid = 1;
    water.blocks = blocks.data();
    water.block_count = 2;
    water.fluid_count = 1;
    water.fluids = kinds.data();
    EXPECT_EQ(sluice_set_water(fluid.get(), &water), SLUICE_ERROR_INVALID_ARGUMENT);
    const auto said = [&] { return std::string(sluice_last_error(fluid.get())); };
    EXPECT_NE(said().find("water.blocks: block 0 is of fluid 1, and there are 1"), std::string::npos) << said();
    water.fluid_count = 2;
    kinds[1].density = 0.01F;
    EXPECT_EQ(sluice_set_water(fluid.get(), &water), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(said().find("at most 16 times as dense"), std::string::npos) << said();
    kinds[1].density = 0.25F;
    ASSERT_EQ(sluice_set_water(fluid.get(), &water), SLUICE_OK) << sluice_last_error(fluid.get());
    SluiceFlow flow{};
    sluice_flow_of(&water, &flow, sizeof(flow));
    ASSERT_EQ(flow.fluid_count, 2U);
    flow.fluids[1].viscosity = 0.5F;
    const SluiceLook oil{{0.2F, 0.8F, 9.0F}, {}};
    EXPECT_EQ(sluice_set_other_looks(fluid.get(), &oil, SLUICE_MAX_FLUIDS), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(said().find("expected at most 7, found 8"), std::string::npos) << said();
    log.lines.clear();
    EXPECT_EQ(frame(fluid.get(), 1.0), SLUICE_OK) << sluice_last_error(fluid.get());
    const auto alike = pixels(screen.name());
    EXPECT_EQ(sluice_set_other_looks(fluid.get(), &oil, 1), SLUICE_OK) << said();
    EXPECT_EQ(frame(fluid.get(), 1.0), SLUICE_OK) << sluice_last_error(fluid.get());
    EXPECT_GT(changed(alike, pixels(screen.name()), 0, kWidth), 100);
    EXPECT_EQ(sluice_set_flow(fluid.get(), &flow), SLUICE_OK) << sluice_last_error(fluid.get());
    EXPECT_EQ(frame(fluid.get(), 1.04), SLUICE_OK) << sluice_last_error(fluid.get());
    EXPECT_EQ(frame(fluid.get(), 1.08), SLUICE_OK) << sluice_last_error(fluid.get());
    const SluiceStatistics statistics = statisticsOf(fluid.get());
    EXPECT_EQ(statistics.particles, 2U * 5 * 2 * 5);
    EXPECT_EQ(statistics.simulation_failed, 0U);
    EXPECT_EQ(log.lines, std::vector<std::string>{});
}

/// Fluid falls away from the camera; behind a wall of depth alone, half a metre behind the fluid, it would not be seen.
int seenAfterItsFall(std::uint32_t depth_scale) {
    const EglCaller caller({});
    const Buffers screen(kWidth, kHeight, {});
    Log log;
    const Fluid fluid = make(options(log, SLUICE_PROCESS_SAME));
    SluiceWater water{};
    sluice_water_defaults(&water, sizeof(water));
    water.radius = 0.1F;
    SluiceBlock block{};
    for (const std::size_t axis : {0U, 1U, 2U}) {
        water.low[axis] = -2.0F;
        water.high[axis] = 2.0F;
        water.gravity[axis] = axis == 2 ? -9.81F : 0.0F;
        block.low[axis] = -0.5F;
        block.high[axis] = 0.5F;
    }
    water.blocks = &block;
    water.block_count = 1;
    water.depth_scale = depth_scale;
    EXPECT_EQ(sluice_set_water(fluid.get(), &water), SLUICE_OK) << sluice_last_error(fluid.get());
    const Camera eye = camera();
    constexpr double kWall = 5.0;  // metres before the camera, which is 4 m before the origin
    const double depth = 0.5 - 0.5 * (double{eye.projection[10]} - double{eye.projection[14]} / kWall);
    int seen = 0;
    for (int k = 0; k < 16; ++k) {
        EXPECT_EQ(sluice_begin_frame(fluid.get(), eye.view.data(), eye.projection.data(), 0.05 * k), SLUICE_OK);
        glClearDepth(depth);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        const auto before = pixels(screen.name());
        EXPECT_EQ(sluice_end_frame(fluid.get()), SLUICE_OK) << sluice_last_error(fluid.get());
        seen = changed(before, pixels(screen.name()), 0, kWidth);
    }
    EXPECT_EQ(log.lines, std::vector<std::string>{});
    return seen;
}

TEST(Api, FluidCollidesWithTheEnginesDepth) {
    EXPECT_EQ(seenAfterItsFall(0), 0) << "through the wall, out of sight";
    EXPECT_GT(seenAfterItsFall(2), 100);
}

TEST(Api, InAProcessOfItsOwn) {
    const EglCaller caller({});
    const Buffers screen(kWidth, kHeight, {});
    Log log;
    const Fluid fluid = make(options(log, SLUICE_PROCESS_OWN));
    ASSERT_NE(fluid, nullptr);
    ASSERT_EQ(pour(fluid.get()), SLUICE_OK) << sluice_last_error(fluid.get());
    const Seen seen = lookAt(fluid.get(), screen.name());
    EXPECT_EQ(seen.wall, 0);
    EXPECT_GT(seen.open, 300);
    EXPECT_EQ(log.lines, std::vector<std::string>{});

    EXPECT_EQ(childrenOfThisProcess(), std::vector<pid_t>{}) << "an engine may wait for all of its own";
    const pid_t renderer = rendererOfThisProcess();
    ASSERT_GT(renderer, 0);
    // What goes to the whole group of processes is the engine's to take or to ignore.
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        ASSERT_EQ(::kill(renderer, signal), 0);
    }
    EXPECT_EQ(frame(fluid.get(), 1.05), SLUICE_OK) << sluice_last_error(fluid.get());
    EXPECT_EQ(statisticsOf(fluid.get()).renderers, 1U);
    EXPECT_EQ(log.lines, std::vector<std::string>{});
    ASSERT_EQ(::kill(renderer, SIGKILL), 0);
    drawRoom();
    const auto without = pixels(screen.name());
    SluiceResult result = SLUICE_ERROR_DEVICE_LOST;
    for (int frames = 0; frames < 40 && (result != SLUICE_OK || log.lines.empty()); ++frames) {
        result = frame(fluid.get(), 1.1);
    }
    EXPECT_EQ(result, SLUICE_OK) << sluice_last_error(fluid.get());
    EXPECT_NE(pixels(screen.name()), without);
    const SluiceStatistics statistics = statisticsOf(fluid.get());
    EXPECT_EQ(statistics.renderers, 2U);
    EXPECT_LE(log.lines.size(), 3U) << log.lines.back();
    EXPECT_NE(log.lines[0].find("has ended"), std::string::npos) << log.lines[0];
}

TEST(Api, FramesAreTheEnginesOwnUntilARendererThatStartsBesideThemIsThere) {
    const EglCaller caller({});
    const Buffers screen(kWidth, kHeight, {});
    Log log;
    SluiceOptions asked = options(log, SLUICE_PROCESS_OWN);
    asked.start_in_background = 1;
    const Fluid fluid = make(asked);
    ASSERT_NE(fluid, nullptr);
    ASSERT_EQ(pour(fluid.get()), SLUICE_OK) << sluice_last_error(fluid.get());
    SluiceResult result = SLUICE_NOT_READY;
    int frames = 0;
    for (; result == SLUICE_NOT_READY && frames < 6000; ++frames) {
        drawRoom();
        const auto before = pixels(screen.name());
        result = frame(fluid.get(), 0.02 * frames);
        EXPECT_EQ(pixels(screen.name()) == before, result == SLUICE_NOT_READY) << frames;
        ::usleep(10'000);
    }
    EXPECT_EQ(result, SLUICE_OK) << sluice_last_error(fluid.get());
    EXPECT_EQ(statisticsOf(fluid.get()).frames_without, static_cast<std::uint64_t>(frames - 1));
    EXPECT_EQ(log.lines, std::vector<std::string>{});
    const Fluid never = make(asked);  // let go of while it starts
    EXPECT_NE(never, nullptr);
}

}  // namespace
}  // namespace sluice::test
