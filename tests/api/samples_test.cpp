// SPDX-License-Identifier: MIT
// A pixel of several samples over an edge has a colour of both sides, and the depth of one.
#include <gtest/gtest.h>

#include <algorithm>

#include "fluid.hpp"

namespace sluice::test {
namespace {

/// A slanting red beam between the eye and the fluid, before a green ground: its edges go through pixels. `up` 1 or -1,
/// which mirrors it: on which side of the beam such pixels have the ground's depth is the driver's choice.
void drawBeam(const Camera& eye, float up) {
    glClearColor(0.1F, 0.3F, 0.1F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glMatrixMode(GL_PROJECTION);
    glLoadMatrixf(eye.projection.data());
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glColor3f(0.8F, 0.1F, 0.1F);
    glBegin(GL_QUADS);
    glVertex3f(-1.0F, -0.16F * up, -1.0F);
    glVertex3f(1.0F, 0.04F * up, -1.0F);
    glVertex3f(1.0F, 0.16F * up, -1.0F);
    glVertex3f(-1.0F, -0.04F * up, -1.0F);
    glEnd();
    glDisable(GL_DEPTH_TEST);
}

/// Two metres before the middle of the fluid.
Camera near() {
    Camera eye = camera();
    eye.view[13] = 0.0F;
    eye.view[14] = -1.8F;
    return eye;
}

/// Water that only refracts, and takes the ground's blue away.
Fluid clearWater(Log& log) {
    Fluid fluid = make(options(log, SLUICE_PROCESS_SAME, 0, 0));
    EXPECT_EQ(pour(fluid.get()), SLUICE_OK) << sluice_last_error(fluid.get());
    SluiceFluid look{};
    sluice_look_defaults(&look);
    look.reflection = 0;
    look.absorption[0] = look.absorption[1] = 0.0F;
    look.absorption[2] = 5.0F;
    std::fill_n(look.scatter_colour, 3, 0.0F);
    look.index_of_refraction = 2.0F;
    EXPECT_EQ(sluice_set_look(fluid.get(), &look), SLUICE_OK);
    SluiceSky dark{};
    sluice_sky_defaults(&dark);
    std::fill_n(dark.sun_radiance, 3, 0.0F);
    EXPECT_EQ(sluice_set_sky(fluid.get(), &dark), SLUICE_OK);
    return fluid;
}

struct Streaks {
    int red = 0;      ///< pixels of the water that have some of the beam's colour
    int changed = 0;  ///< that the water changed
};

bool isRed(const std::vector<std::uint8_t>& picture, GLsizei x, GLsizei y) {
    return picture[static_cast<std::size_t>(y * kWidth + x) * 4] > 40;
}

/// Two pixels from the beam at least.
Streaks streaksIn(GLuint framebuffer, float up) {
    Log log;
    const Fluid fluid = clearWater(log);
    const Camera eye = near();
    drawBeam(eye, up);
    const auto bare = pixels(framebuffer);
    EXPECT_EQ(sluice_begin_frame(fluid.get(), eye.view.data(), eye.projection.data(), 1.0), SLUICE_OK);
    drawBeam(eye, up);
    EXPECT_EQ(sluice_end_frame(fluid.get()), SLUICE_OK) << sluice_last_error(fluid.get());
    const auto seen = pixels(framebuffer);
    Streaks found;
    for (GLsizei y = 2; y < kHeight - 2; ++y) {
        for (GLsizei x = 2; x < kWidth - 2; ++x) {
            bool beside = false;
            for (int near_by = 0; near_by < 25; ++near_by) {
                beside = beside || isRed(bare, x + near_by % 5 - 2, y + near_by / 5 - 2);
            }
            found.red += !beside && isRed(seen, x, y) ? 1 : 0;
        }
    }
    found.changed = changed(bare, seen, 0, kWidth);
    EXPECT_EQ(log.lines, std::vector<std::string>{});
    return found;
}

TEST(Samples, WhatStandsBeforeTheWaterLeavesNoStreaksInIt) {
    const EglCaller caller({4, 5, false}, Window{kWidth, kHeight, 4, false});
    ASSERT_TRUE(caller.ok()) << "no such window";
    for (const float up : {1.0F, -1.0F}) {
        SCOPED_TRACE(up);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        const Streaks window = streaksIn(0, up);
        EXPECT_EQ(window.red, 0) << "in a window";
        EXPECT_GT(window.changed, 300);
        const Buffers buffers(kWidth, kHeight, {GL_RGBA8, GL_DEPTH24_STENCIL8, 4});
        const Streaks object = streaksIn(buffers.name(), up);
        EXPECT_EQ(object.red, 0) << "in a framebuffer object";
        EXPECT_GT(object.changed, 300);
    }
}

}  // namespace
}  // namespace sluice::test
