// SPDX-License-Identifier: MIT
// libsluice.so in GLX contexts, with windows of an X server of the test's own.
#include <gtest/gtest.h>

#include <string>

#include "fluid.hpp"
#include "glx_caller.hpp"
#include "sluice/host_gl/state_snapshot.hpp"

namespace sluice::test {
namespace {

class Glx : public ::testing::Test {
  protected:
    static void SetUpTestSuite() { server_ = std::make_unique<XServer>(); }
    static void TearDownTestSuite() { server_.reset(); }
    void SetUp() override {
        if (server_->display().empty()) {
            GTEST_SKIP() << "Xvfb does not run here; apt-get install xvfb";
        }
    }
    static const XServer& server() { return *server_; }

  private:
    static inline std::unique_ptr<XServer> server_;
};

struct Case {
    const char* name;
    Version version;
    Window window;
};

/// The pictures of all of them must be one.
TEST_F(Glx, FluidIsBehindTheWallAndNoStateIsLeft) {
    const std::array<Case, 5> cases{{{"an old engine's", {1, 5, false}, {}},
                                     {"2.1", {2, 1, false}, {}},
                                     {"3.3 core", {3, 3, true}, {}},
                                     {"4.5 core, four samples", {4, 5, true}, {kWidth, kHeight, 4, false}},
                                     {"4.5, sRGB", {4, 5, false}, {kWidth, kHeight, 0, true}}}};
    std::vector<std::uint8_t> first;
    for (const Case& one : cases) {
        SCOPED_TRACE(one.name);
        const GlxCaller caller(server(), one.version, one.window);
        ASSERT_TRUE(caller.ok()) << "no such context";
        Log log;
        const Fluid fluid = make(options(log, SLUICE_PROCESS_SAME, 0, 0));
        ASSERT_NE(fluid, nullptr);
        ASSERT_EQ(pour(fluid.get()), SLUICE_OK);
        drawRoom();
        const host::StateSnapshot before = host::takeStateSnapshot();
        const auto picture = firstFrame(fluid.get(), 0, one.window.srgb);
        EXPECT_EQ(host::differences(before, host::takeStateSnapshot()), std::vector<std::string>{});
        if (first.empty()) {
            first = picture;
            drawRoom();
            const auto bare = pixels(0);
            EXPECT_EQ(changed(bare, picture, 0, kWidth / 3), 0);
            EXPECT_GT(changed(bare, picture, kWidth / 3, kWidth), 300);
        }
        EXPECT_EQ(picture, first);
        EXPECT_EQ(log.lines, std::vector<std::string>{});
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    }
}

TEST_F(Glx, TheWindowIsResizedWhileItsFluidIsInAnotherProcess) {
    GlxCaller caller(server(), {2, 1, false}, Window{});
    ASSERT_TRUE(caller.ok());
    Log log;
    const Fluid fluid = make(options(log, SLUICE_PROCESS_OWN, 0, 0));
    ASSERT_NE(fluid, nullptr);
    ASSERT_EQ(pour(fluid.get()), SLUICE_OK);
    for (const GLsizei width : {96, 150, 60}) {
        caller.resize(width, kHeight);
        caller.swap();
        drawRoom(width);
        const auto before = pixels(0, width);
        ASSERT_EQ(frame(fluid.get(), 1.0, width), SLUICE_OK) << sluice_last_error(fluid.get());
        const auto after = pixels(0, width);
        EXPECT_EQ(changed(before, after, 0, width / 3, width), 0) << width;
        EXPECT_GT(changed(before, after, width / 3, width, width), 100) << width;
        EXPECT_EQ(statisticsOf(fluid.get()).width, static_cast<std::uint32_t>(width));
    }
    EXPECT_EQ(statisticsOf(fluid.get()).renderers, 1U);
    EXPECT_EQ(log.lines, std::vector<std::string>{});
}

}  // namespace
}  // namespace sluice::test
