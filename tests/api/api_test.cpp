// SPDX-License-Identifier: MIT
// libsluice.so in contexts that it did not make.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "caller.hpp"
#include "sluice/host_gl/state_snapshot.hpp"

extern "C" {
int c99_uses_the_library(void);
int c99_loads_the_library(const char* path, char* why, std::size_t size);
}

namespace sluice::test {
namespace {

struct Destroy {
    void operator()(Sluice* fluid) const { sluice_destroy(fluid); }
};
using Fluid = std::unique_ptr<Sluice, Destroy>;

Fluid make(const SluiceOptions& options) {
    Sluice* fluid = nullptr;
    EXPECT_EQ(sluice_create(&options, &fluid), SLUICE_OK) << sluice_last_error(nullptr);
    return Fluid(fluid);
}

/// Frame 2, after the fluid's start: what changed left, under the wall, and right of it.
struct Seen {
    int wall, open;
};
Seen lookAt(Sluice* fluid, GLuint framebuffer) {
    drawRoom();
    const auto before = pixels(framebuffer);
    EXPECT_EQ(frame(fluid, 1.0), SLUICE_OK) << sluice_last_error(fluid);
    const auto after = pixels(framebuffer);
    return {changed(before, after, 0, kWidth / 3), changed(before, after, kWidth / 3, kWidth)};
}

class InContext : public ::testing::TestWithParam<Version> {};

TEST_P(InContext, FluidIsBehindTheWallAndNoStateIsLeft) {
    const EglCaller caller(GetParam());
    ASSERT_TRUE(caller.ok()) << "no such context";
    const Buffers screen(kWidth, kHeight, {});
    Log log;
    const host::StateSnapshot before = host::takeStateSnapshot();
    const Fluid fluid = make(options(log, SLUICE_PROCESS_SAME));
    ASSERT_NE(fluid, nullptr);
    ASSERT_EQ(pour(fluid.get()), SLUICE_OK) << sluice_last_error(fluid.get());
    EXPECT_EQ(host::differences(before, host::takeStateSnapshot()), std::vector<std::string>{});
    drawRoom();
    const host::StateSnapshot drawing = host::takeStateSnapshot();
    const Seen seen = lookAt(fluid.get(), screen.name());
    EXPECT_EQ(host::differences(drawing, host::takeStateSnapshot()), std::vector<std::string>{});
    EXPECT_EQ(seen.wall, 0);
    EXPECT_GT(seen.open, 300);
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
}

}  // namespace
}  // namespace sluice::test
