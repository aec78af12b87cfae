// SPDX-License-Identifier: MIT
// What an engine does otherwise than libsluice.so takes it to, and how it is told.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "fluid.hpp"

namespace sluice::test {
namespace {

/// A camera whose near and far may be swapped.
std::array<float, 16> frustum(float near, float far) {
    std::array<float, 16> p = camera().projection;
    p[10] = -(far + near) / (far - near);
    p[14] = -2.0F * far * near / (far - near);
    return p;
}

/// What an engine in a window of kWidth by kHeight gets of a frame.
class Misuse : public ::testing::Test {
  protected:
    void begin(std::uint32_t width = 0, std::uint32_t height = 0) {
        fluid_ = make(options(log_, SLUICE_PROCESS_SAME, width, height));
        ASSERT_NE(fluid_, nullptr);
        ASSERT_EQ(pour(fluid_.get()), SLUICE_OK) << sluice_last_error(fluid_.get());
    }

    SluiceResult frameWith(
        const std::array<float, 16>& projection, const std::function<void()>& at_end = [] {}) {
        const Camera eye = camera();
        (void)sluice_begin_frame(fluid_.get(), eye.view.data(), projection.data(), 1.0);
        drawRoom();
        at_end();
        return sluice_end_frame(fluid_.get());
    }

    void expectTold(const char* what) {
        ASSERT_EQ(log_.lines.size(), 1U) << what;
        EXPECT_NE(log_.lines[0].find(what), std::string::npos) << log_.lines[0];
        log_.lines.clear();
    }

    EglCaller caller_{{2, 1, false}, Window{}};
    Log log_;
    Fluid fluid_;
};

TEST_F(Misuse, ReversedDepthIsRefusedByName) {
    begin();
    for (int repeated = 0; repeated < 2; ++repeated) {
        EXPECT_EQ(frameWith(frustum(100.0F, 0.1F)), SLUICE_ERROR_INVALID_ARGUMENT);
    }
    expectTold("near 100 and far 0.1, expected 0 < near < far");
    const auto reversed = [] {
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_GEQUAL);
        glClearDepth(0.0);
    };
    EXPECT_EQ(frameWith(frustum(0.1F, 100.0F), reversed), SLUICE_ERROR_INVALID_ARGUMENT);
    expectTold("GL_GEQUAL and glClearDepth 0");
    glClearDepth(1.0);
    EXPECT_EQ(frameWith(frustum(0.1F, 100.0F)), SLUICE_OK) << sluice_last_error(fluid_.get());
    std::array<float, 16> beyond = frustum(0.1F, 100.0F);  // a far plane beyond infinity, as shadow volumes want it
    beyond[10] = -0.999F;
    EXPECT_EQ(frameWith(beyond), SLUICE_OK) << sluice_last_error(fluid_.get());
}

TEST_F(Misuse, MatricesInRowOrderAreRefusedByName) {
    begin();
    const Camera eye = camera();
    Camera rows{};
    for (std::size_t i = 0; i < 16; ++i) {
        rows.view.at(i) = eye.view.at(i % 4 * 4 + i / 4);
        rows.projection.at(i) = eye.projection.at(i % 4 * 4 + i / 4);
    }
    (void)sluice_begin_frame(fluid_.get(), rows.view.data(), rows.projection.data(), 1.0);
    EXPECT_EQ(sluice_end_frame(fluid_.get()), SLUICE_ERROR_INVALID_ARGUMENT);
    expectTold("camera: elements 3, 7, 11 and 15 of its view are");
    EXPECT_EQ(frameWith(eye.projection), SLUICE_OK) << sluice_last_error(fluid_.get());
}

TEST_F(Misuse, AFailureWithOtherNumbersInEachFrameIsToldOnce) {
    begin();
    const Camera eye = camera();
    for (int k = 0; k < 5; ++k) {
        Camera rows{};
        rows.projection = eye.projection;
        const float turn = 0.3F * static_cast<float>(k);
        rows.view = {std::cos(turn),  0, std::sin(turn), 0.1F, 0, 1, 0, -0.5F,
                     -std::sin(turn), 0, std::cos(turn), -4,   0, 0, 0, 1};
        rows.view[3] -= turn;
        (void)sluice_begin_frame(fluid_.get(), rows.view.data(), rows.projection.data(), 1.0 + 0.1 * k);
        EXPECT_EQ(sluice_end_frame(fluid_.get()), SLUICE_ERROR_INVALID_ARGUMENT);
    }
    expectTold("camera: elements 3, 7, 11 and 15 of its view are");
    for (int k = 0; k < 3; ++k) {  // a good frame between them makes no news of it
        EXPECT_EQ(frame(fluid_.get(), 2.0 + 0.1 * k), SLUICE_OK) << sluice_last_error(fluid_.get());
        EXPECT_EQ(sluice_end_frame(fluid_.get()), SLUICE_ERROR_INVALID_ARGUMENT);
    }
    expectTold("sluice_end_frame: no frame has begun");
}

TEST_F(Misuse, ANumberThatIsNoneIsNamedWithItsRemedy) {
    begin();
    Camera eye = camera();
    eye.view[3] = std::numeric_limits<float>::quiet_NaN();
    (void)sluice_begin_frame(fluid_.get(), eye.view.data(), eye.projection.data(), 1.0);
    EXPECT_EQ(sluice_end_frame(fluid_.get()), SLUICE_ERROR_INVALID_ARGUMENT);
    expectTold("camera: element 3 of its view is nan, expected a finite number (look for a division by zero");
    eye = camera();
    eye.projection[0] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(frameWith(eye.projection), SLUICE_ERROR_INVALID_ARGUMENT);
    expectTold("camera: element 0 of its projection is inf, expected a finite number");
}

/// `scale`: units of the engine's world that a metre has, in its view and in near and far.
std::vector<std::uint8_t> pictureOfUnits(Sluice* fluid, float scale) {
    Camera eye = camera();
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 3; ++row) {
            eye.view.at(column * 4 + row) *= scale;
        }
    }
    eye.projection = frustum(0.1F * scale, 100.0F * scale);
    EXPECT_EQ(sluice_begin_frame(fluid, eye.view.data(), eye.projection.data(), 1.0), SLUICE_OK);
    drawRoom();
    EXPECT_EQ(sluice_end_frame(fluid), SLUICE_OK) << sluice_last_error(fluid);
    return pixels(0);
}

TEST_F(Misuse, AViewThatScalesIsOfAnotherUnitAndOneThatStretchesIsRefusedByName) {
    begin();
    const auto metres = pictureOfUnits(fluid_.get(), 1.0F);
    drawRoom();
    ASSERT_GT(changed(pixels(0), metres, kWidth / 3, kWidth), 300);
    for (const float scale : {100.0F, 0.25F}) {
        begin();
        const auto scaled = pictureOfUnits(fluid_.get(), scale);
        int far = 0;
        for (std::size_t i = 0; i < metres.size(); ++i) {
            far += std::abs(int{metres[i]} - int{scaled[i]}) > 3 ? 1 : 0;
        }
        EXPECT_LE(far, 8) << scale << ", of " << metres.size() << " values";
    }
    EXPECT_EQ(log_.lines, std::vector<std::string>{});
    Camera eye = camera();
    eye.view[5] = 2.0F;
    (void)sluice_begin_frame(fluid_.get(), eye.view.data(), eye.projection.data(), 1.0);
    EXPECT_EQ(sluice_end_frame(fluid_.get()), SLUICE_ERROR_INVALID_ARGUMENT);
    expectTold("camera: its view scales the axes x, y and z by 1, 2 and 1, expected one scale above 0 for all three (");
    eye = camera();
    eye.view[4] = 0.2F;
    (void)sluice_begin_frame(fluid_.get(), eye.view.data(), eye.projection.data(), 1.0);
    EXPECT_EQ(sluice_end_frame(fluid_.get()), SLUICE_ERROR_INVALID_ARGUMENT);
    expectTold("camera: axes x and y of its view have an angle of cosine 0.196116, expected 0 (");
}

/// Walls by what the engine's depth says of them: near the eye on the left, behind the fluid on the right.
std::vector<std::uint8_t> pictureThrough(Sluice* fluid, float low, float high) {
    const Camera eye = camera();
    glDepthRange(double{low}, double{high});
    EXPECT_EQ(sluice_begin_frame(fluid, eye.view.data(), eye.projection.data(), 1.0), SLUICE_OK);
    glEnable(GL_SCISSOR_TEST);
    for (const auto& [distance, from] : {std::pair{1.0F, 0}, std::pair{4.0F, kWidth / 3}}) {
        const float z = -eye.projection[10] + eye.projection[14] / distance;
        glScissor(from, 0, kWidth - from, kHeight);
        glClearDepth(double{low + (high - low) * (z * 0.5F + 0.5F)});
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
    glClearDepth(1.0);
    EXPECT_EQ(sluice_end_frame(fluid), SLUICE_OK) << sluice_last_error(fluid);
    glDepthRange(0.0, 1.0);
    return pixels(0);
}

TEST_F(Misuse, ADepthRangeOfTheWholeWorldIsUndone) {
    const auto seen = [&](float low, float high) {
        begin();
        return pictureThrough(fluid_.get(), low, high);
    };
    const auto whole = seen(0.0F, 1.0F);
    const auto bare = std::vector<std::uint8_t>(whole.size(), 0);
    EXPECT_EQ(changed(bare, whole, 0, kWidth / 3), 0);
    ASSERT_GT(changed(bare, whole, kWidth / 3, kWidth), 100);
    for (const auto& [low, high] : {std::pair{0.0F, 0.5F}, std::pair{0.25F, 0.75F}}) {
        const auto part = seen(low, high);
        int far = 0;
        for (std::size_t i = 0; i < whole.size(); ++i) {
            far += std::abs(int{whole[i]} - int{part[i]}) > 3 ? 1 : 0;
        }
        EXPECT_LE(far, 8) << low << " to " << high << ", of " << whole.size() << " values";
    }
    EXPECT_EQ(log_.lines, std::vector<std::string>{});
    begin();
    glDepthRange(1.0, 0.0);
    EXPECT_EQ(frameWith(camera().projection), SLUICE_ERROR_INVALID_ARGUMENT);
    expectTold("through glDepthRange(1, 0), expected 0 < near < far");
}

TEST_F(Misuse, ASizeThatIsNotTheWindowsIsTold) {
    begin(kWidth + 20, kHeight);
    EXPECT_EQ(frameWith(camera().projection), SLUICE_ERROR_INVALID_ARGUMENT);
    expectTold("window bound for drawing: it is 96x64, Sluice was told 116x64");
    ASSERT_EQ(sluice_resize(fluid_.get(), kWidth / 2, kHeight), SLUICE_OK);
    const auto viewport = [](GLsizei width) { return [width] { glViewport(0, 0, width, kHeight); }; };
    EXPECT_EQ(frameWith(camera().projection, viewport(kWidth)), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(sluice_last_error(fluid_.get())).find("it is 96x64, Sluice was told 48x64"),
              std::string::npos);
    EXPECT_EQ(log_.lines, std::vector<std::string>{}) << "the log has heard of that kind of failure";
    EXPECT_EQ(frameWith(camera().projection, viewport(kWidth / 2)), SLUICE_OK) << "a part of the window";
    EXPECT_EQ(log_.lines, std::vector<std::string>{});
}

struct Slip {
    const char* told;
    std::function<void(SluiceWater&, SluiceBlock&, SluiceEmitter&, SluiceSolid&, SluiceBody&)> slip;
};

TEST_F(Misuse, WaterThatCannotBeIsNamedWithItsRemedy) {
    begin();
    const std::array<Slip, 9> slips{{
        {"block 0, [0.5, 0.5, -0.5] to [-0.5, 1.5, 0.5], is -1 m wide along axis 0 and holds no particle of radius "
         "0.1 m (low is the corner",
         [](auto&, auto& block, auto&, auto&, auto&) { std::swap(block.low[0], block.high[0]); }},
        {"is 0.1 m wide along axis 1 and holds no particle of radius 0.1 m (make it at least two radii wide",
         [](auto&, auto& block, auto&, auto&, auto&) { block.high[1] = block.low[1] + 0.1F; }},
        {"sticks out of the box, [-1, 0, -1] to [1, 2, 1], along axis 0 (make the block smaller",
         [](auto&, auto& block, auto&, auto&, auto&) { block.high[0] = 5.0F; }},
        {"outside of the solids (move them out of the solids",
         [](auto&, auto&, auto&, auto& solid, auto&) { solid.b[0] = solid.b[1] = solid.b[2] = 3.0F; }},
        {"found 0 (give a speed", [](auto&, auto&, auto& tap, auto&, auto&) { tap.speed = 0.0F; }},
        {"(move its centre into the box", [](auto&, auto&, auto& tap, auto&, auto&) { tap.centre[0] = -5.0F; }},
        {"(give one from SLUICE_SOLID_PLANE", [](auto&, auto&, auto&, auto& solid, auto&) { solid.kind = 9; }},
        {"(density is in terms of the fluid's", [](auto&, auto&, auto&, auto&, auto& body) { body.density = 0.0F; }},
        {"set depth_scale to 0)", [](auto& water, auto&, auto&, auto&, auto&) { water.depth_scale = 4; }},
    }};
    for (const Slip& slip : slips) {
        SluiceBlock block{{-0.5F, 0.5F, -0.5F}, {0.5F, 1.5F, 0.5F}, {}, 0, {}};
        SluiceEmitter tap{};
        tap.centre[1] = 1.8F;
        tap.direction[1] = -1.0F;
        tap.width = tap.height = 0.2F;
        tap.speed = 1.0F;
        SluiceSolid solid{};
        solid.kind = SLUICE_SOLID_BOX;
        solid.a[1] = 1.0F;
        solid.b[0] = solid.b[1] = solid.b[2] = 0.05F;
        SluiceBody body{};
        body.shape = SLUICE_SOLID_BOX;
        body.centre[1] = 0.2F;
        body.half[0] = body.half[1] = body.half[2] = 0.1F;
        body.density = 0.5F;
        SluiceWater water{};
        sluice_water_defaults(&water, sizeof(water));
        water.radius = 0.1F;
        water.block_count = water.emitter_count = water.solid_count = water.body_count = 1;
        water.blocks = &block;
        water.emitters = &tap;
        water.solids = &solid;
        water.bodies = &body;
        slip.slip(water, block, tap, solid, body);
        EXPECT_EQ(sluice_set_water(fluid_.get(), &water), SLUICE_ERROR_INVALID_ARGUMENT);
        expectTold(slip.told);
    }
}

TEST_F(Misuse, WhatTheNextContextsRendererRefusesIsNamedInEveryFrameUntilItIsSetAnew) {
    begin();
    EXPECT_EQ(frame(fluid_.get(), 1.0), SLUICE_OK) << sluice_last_error(fluid_.get());
    caller_.destroyContext();
    SluiceEmitter tap{};
    tap.centre[1] = 1.8F;
    tap.direction[1] = -1.0F;
    tap.width = tap.height = 0.2F;
    SluiceWater water{};
    sluice_water_defaults(&water, sizeof(water));
    water.emitter_count = 1;
    water.emitters = &tap;
    EXPECT_EQ(sluice_set_water(fluid_.get(), &water), SLUICE_OK) << "there is no renderer to refuse it yet";
    const EglCaller second({4, 5, true}, Window{});
    const Camera eye = camera();
    for (int k = 0; k < 9; ++k) {  // tries to give it lie 1, 2, 4 frames apart
        const double time = 1.1 + 0.1 * k;
        EXPECT_EQ(sluice_begin_frame(fluid_.get(), eye.view.data(), eye.projection.data(), time),
                  SLUICE_ERROR_INVALID_ARGUMENT);
        EXPECT_EQ(sluice_end_frame(fluid_.get()), SLUICE_ERROR_INVALID_ARGUMENT);
        EXPECT_NE(std::string(sluice_last_error(fluid_.get())).find("a speed in (0, 10000]"), std::string::npos)
            << sluice_last_error(fluid_.get());
    }
    EXPECT_EQ(statisticsOf(fluid_.get()).renderers, 1U) << "it is not the renderer that is at fault";
    ASSERT_EQ(log_.lines.size(), 2U) << "that everything is made anew, and why it cannot be";
    EXPECT_NE(log_.lines[1].find("emitter 0: speed: expected"), std::string::npos) << log_.lines[1];
    log_.lines.clear();
    ASSERT_EQ(pour(fluid_.get()), SLUICE_OK) << sluice_last_error(fluid_.get());
    EXPECT_EQ(frame(fluid_.get(), 2.1), SLUICE_OK) << sluice_last_error(fluid_.get());
    EXPECT_EQ(log_.lines, std::vector<std::string>{});
}

TEST_F(Misuse, WaterThatIsSetWithinAFrameIsOfTheNext) {
    fluid_ = make(options(log_, SLUICE_PROCESS_SAME, 0, 0));
    const Camera eye = camera();
    for (int k = 0; k < 2; ++k) {  // the first frame began without water, the second with other water
        EXPECT_EQ(sluice_begin_frame(fluid_.get(), eye.view.data(), eye.projection.data(), 1.0), SLUICE_OK);
        ASSERT_EQ(pour(fluid_.get()), SLUICE_OK) << sluice_last_error(fluid_.get());
        EXPECT_EQ(sluice_end_frame(fluid_.get()), SLUICE_NOT_READY);
    }
    EXPECT_EQ(frame(fluid_.get(), 1.1), SLUICE_OK) << sluice_last_error(fluid_.get());
    EXPECT_EQ(log_.lines, std::vector<std::string>{});
}

}  // namespace
}  // namespace sluice::test
