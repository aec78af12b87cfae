// SPDX-License-Identifier: MIT
// Frames of programs as streams of calls, and what the tracker makes of them.
#include "tracker/frame_tracker.hpp"

#include <gtest/gtest.h>

#include "matrices.hpp"
#include "tracker/refusal.hpp"

namespace sluice::inject::test {
namespace {

const Matrix kLens = frustum(-0.1, 0.1, -0.075, 0.075, 0.1, 512);

/// A program's fixed function: what it would answer when asked for its matrices.
class Fixed {
  public:
    explicit Fixed(FrameTracker& tracker) : tracker_(tracker) {}
    void project(const Matrix& matrix) {
        tracker_.matrixMode(true, false);
        projection_ = matrix;
        tracker_.matrixChanged();
        tracker_.matrixMode(false, true);
    }
    void model(const Matrix& matrix) {
        model_view_ = matrix;
        tracker_.matrixChanged();
    }
    void push() { tracker_.pushedView(tracker_.wantsPushedView() ? model_view_ : kIdentity); }
    void pop() { tracker_.popped(); }
    bool draw(std::uint32_t vertices) {
        if (tracker_.wantsMatrices()) {
            ++asked_;
            tracker_.fixedMatrices(projection_, model_view_);
        }
        return tracker_.draw(vertices);
    }
    [[nodiscard]] int asked() const { return asked_; }

  private:
    FrameTracker& tracker_;
    Matrix projection_ = kIdentity, model_view_ = kIdentity;
    int asked_ = 0;
};

TEST(FrameTracker, FluidBelongsBeforeTheOverlayFromTheSecondFrameOn) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    for (int frame = 0; frame < 3; ++frame) {
        fixed.project(kLens);
        EXPECT_FALSE(fixed.draw(1000));
        fixed.project(ortho());
        EXPECT_EQ(fixed.draw(4), frame > 0) << frame;
        EXPECT_FALSE(fixed.draw(4));
        tracker.endFrame();
        EXPECT_EQ(tracker.lastFrame().composited_early, frame > 0);
    }
}

TEST(FrameTracker, AnOverlayInTheMiddleOfTheSceneIsPassedOver) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    std::vector<bool> moments;
    for (int frame = 0; frame < 3; ++frame) {
        moments.clear();
        fixed.project(kLens);
        moments.push_back(fixed.draw(500));
        fixed.project(ortho());  // a sky, a mirror's mask
        moments.push_back(fixed.draw(4));
        fixed.project(kLens);
        moments.push_back(fixed.draw(900));
        fixed.project(ortho());
        moments.push_back(fixed.draw(4));
        tracker.endFrame();
    }
    EXPECT_EQ(moments, (std::vector<bool>{false, false, false, true}));
}

TEST(FrameTracker, WithoutAnOverlayTheSwapIsTheMoment) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    for (int frame = 0; frame < 3; ++frame) {
        fixed.project(ortho());
        EXPECT_FALSE(fixed.draw(4));
        fixed.project(kLens);
        EXPECT_FALSE(fixed.draw(100));
        tracker.endFrame();
    }
    EXPECT_FALSE(tracker.lastFrame().composited_early);
    EXPECT_TRUE(tracker.camera());
}

TEST(FrameTracker, AWeaponOverAClearedDepthComesAfterTheFluid) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    for (int frame = 0; frame < 3; ++frame) {
        EXPECT_FALSE(tracker.clearsDepth());
        fixed.project(kLens);
        EXPECT_FALSE(fixed.draw(5000));
        EXPECT_EQ(tracker.clearsDepth(), frame > 0);
        fixed.project(frustum(-1, 1, -1, 1, 1, 10));
        EXPECT_FALSE(fixed.draw(300));
        tracker.endFrame();
    }
    ASSERT_TRUE(tracker.camera());
    EXPECT_NEAR(tracker.camera()->lens.near_plane, 0.1, 1e-3);
    EXPECT_LT(tracker.camera()->confidence, 0.95);
}

TEST(FrameTracker, TheCameraIsTheLensWithTheMostVertices) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    fixed.project(frustum(-1, 1, -1, 1, 1, 10));
    (void)fixed.draw(10);
    fixed.project(kLens);
    (void)fixed.draw(1000);
    const std::optional<FoundCamera> camera = tracker.camera();
    ASSERT_TRUE(camera);
    EXPECT_NEAR(camera->lens.far_plane, 512, 5);
    EXPECT_EQ(camera->source, "projection matrix");
}

TEST(FrameTracker, TheViewIsThePushBeforeTheFirstDrawElseThatDrawsModelView) {
    const Matrix view = product(turn(20), translation(0, -1, -9));
    FrameTracker tracker;
    Fixed fixed(tracker);
    fixed.project(kLens);
    fixed.model(view);
    fixed.push();
    fixed.model(product(view, translation(3, 0, 0)));
    (void)fixed.draw(100);
    ASSERT_TRUE(tracker.camera());
    EXPECT_NEAR(tracker.camera()->view[12], view[12], 1e-4F);
    fixed.pop();
    tracker.endFrame();
    fixed.model(view);
    (void)fixed.draw(100);
    EXPECT_NEAR(tracker.camera()->view[14], view[14], 1e-4F);
    EXPECT_EQ(tracker.camera()->view_source, "model-view matrix at the first draw");
}

TEST(FrameTracker, ASkyThatGoesWithTheEyeDoesNotPassForTheView) {
    const Matrix view = product(turn(20), translation(0, -1, -9));
    FrameTracker tracker;
    Fixed fixed(tracker);
    fixed.project(kLens);
    fixed.model(kIdentity);
    fixed.push();
    fixed.model(view);
    fixed.push();
    fixed.model(turn(20));
    fixed.push();
    (void)fixed.draw(100);  // the sky
    fixed.pop();
    fixed.pop();
    fixed.model(view);
    for (int body = 0; body < 3; ++body) {
        fixed.push();
        fixed.model(product(view, translation(static_cast<float>(body), 0, 0)));
        (void)fixed.draw(500);
        fixed.pop();
        fixed.model(view);
    }
    ASSERT_TRUE(tracker.camera());
    EXPECT_EQ(tracker.camera()->view_source, "lowest model-view matrix on the stack");
    EXPECT_NEAR(tracker.camera()->view[14], view[14], 1e-4F);
    EXPECT_GT(tracker.camera()->view_confidence, 0.8);
}

TEST(FrameTracker, AProjectionThatIsSetOnceIsStillAskedForOncePerFrame) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    fixed.project(kLens);
    for (int frame = 0; frame < 3; ++frame) {
        for (int i = 0; i < 10; ++i) {
            (void)fixed.draw(10);
        }
        tracker.endFrame();
    }
    EXPECT_EQ(fixed.asked(), 3);
}

TEST(FrameTracker, AProgramOfShadersIsKnownByItsMatrices) {
    FrameTracker tracker;
    std::vector<bool> moments;
    for (int frame = 0; frame < 2; ++frame) {
        moments.clear();
        tracker.useProgram(3);
        for (int i = 0; i < 4; ++i) {
            tracker.uniform(3, 0, product(kLens, translation(static_cast<float>(i), 0, -5)), UniformName::Unknown);
            moments.push_back(tracker.draw(300));
        }
        tracker.useProgram(7);
        moments.push_back(tracker.draw(4));
        tracker.endFrame();
    }
    EXPECT_EQ(moments, (std::vector<bool>{false, false, false, false, true}));
    ASSERT_TRUE(tracker.camera());
    EXPECT_NEAR(tracker.camera()->lens.near_plane, 0.1, 2e-3);
    EXPECT_GT(tracker.camera()->confidence, 0.8);  // four objects agree
}

TEST(FrameTracker, AViewThatIsNamedSoGoesWithAPureProjection) {
    FrameTracker tracker;
    tracker.useProgram(1);
    tracker.uniform(1, 0, kLens, UniformName::Unknown);
    tracker.uniform(1, 1, translation(0, -2, -8), UniformName::View);
    tracker.uniform(1, 2, translation(5, 5, 5), UniformName::Unknown);
    tracker.uniform(1, 3, translation(7, 7, 7), UniformName::ModelView);
    (void)tracker.draw(10);
    ASSERT_TRUE(tracker.camera());
    EXPECT_EQ(tracker.camera()->view, translation(0, -2, -8));
}

TEST(FrameTracker, MatricesThatAreWrittenRowByRowAreTheSameCamera) {
    FrameTracker tracker;
    tracker.useProgram(1);
    tracker.uniform(1, 0, transposed(kLens), UniformName::Unknown);
    tracker.uniform(1, 1, transposed(translation(0, -2, -8)), UniformName::View);
    (void)tracker.draw(10);
    ASSERT_TRUE(tracker.camera());
    EXPECT_NEAR(tracker.camera()->lens.near_plane, 0.1, 1e-3);
    EXPECT_EQ(tracker.camera()->view, translation(0, -2, -8));
}

TEST(FrameTracker, AnOverlayMayBeDrawnByTheProgramOfTheScene) {
    FrameTracker tracker;
    std::vector<bool> moments;
    tracker.useProgram(3);
    for (int frame = 0; frame < 2; ++frame) {
        moments.clear();
        tracker.uniform(3, 5, kLens, UniformName::Unknown);
        moments.push_back(tracker.draw(300));
        tracker.uniform(3, 6, ortho(), UniformName::Unknown);  // another matrix of the same program
        moments.push_back(tracker.draw(300));
        tracker.uniform(3, 5, ortho(), UniformName::Unknown);
        moments.push_back(tracker.draw(4));
        tracker.endFrame();
    }
    EXPECT_EQ(moments, (std::vector<bool>{false, false, true}));
}

TEST(FrameTracker, DrawsIntoFramebuffersOfTheProgramsOwnDoNotCountBesideAScene) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    for (int frame = 0; frame < 3; ++frame) {
        EXPECT_FALSE(tracker.bindFramebuffer(4));
        fixed.project(frustum(-1, 1, -1, 1, 1, 10));
        (void)fixed.draw(100000);
        EXPECT_FALSE(tracker.clearsDepth());
        EXPECT_FALSE(tracker.bindFramebuffer(0));
        fixed.project(kLens);
        (void)fixed.draw(10);
        tracker.endFrame();
    }
    EXPECT_EQ(tracker.target(), 0U);
    EXPECT_NEAR(tracker.camera()->lens.near_plane, 0.1, 1e-3);
    EXPECT_EQ(tracker.lastFrame().foreign_draws, 1U);
}

TEST(FrameTracker, ASceneInAFramebufferOfTheProgramsOwnGetsItsFluidBeforeItIsRead) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    std::vector<bool> moments;
    for (int frame = 0; frame < 4; ++frame) {
        moments.clear();
        moments.push_back(tracker.bindFramebuffer(7));  // a shadow
        fixed.project(frustum(-1, 1, -1, 1, 1, 10));
        moments.push_back(fixed.draw(100));
        moments.push_back(tracker.bindFramebuffer(4));
        fixed.project(kLens);
        moments.push_back(fixed.draw(5000));
        moments.push_back(tracker.bindFramebuffer(0));
        fixed.project(ortho());
        moments.push_back(fixed.draw(4));
        tracker.endFrame();
    }
    EXPECT_EQ(tracker.target(), 4U);
    EXPECT_EQ(moments, (std::vector<bool>{false, false, false, false, true, false}));
    EXPECT_NEAR(tracker.camera()->lens.far_plane, 512, 5);
    tracker.refuse(4);
    EXPECT_EQ(tracker.target(), 0U);
    (void)tracker.bindFramebuffer(4);
    fixed.project(kLens);
    (void)fixed.draw(5000);
    (void)tracker.bindFramebuffer(0);
    tracker.endFrame();
    EXPECT_EQ(tracker.target(), 0U);
}

TEST(FrameTracker, AFramebufferOutOfReachIsNoTarget) {
    FrameTracker tracker;
    tracker.stayInTheWindow();
    tracker.useProgram(1);
    for (int frame = 0; frame < 2; ++frame) {
        EXPECT_FALSE(tracker.bindFramebuffer(4));
        tracker.uniform(1, 0, kLens, UniformName::Unknown);
        (void)tracker.draw(5000);
        EXPECT_FALSE(tracker.bindFramebuffer(0));
        tracker.endFrame();
    }
    EXPECT_EQ(tracker.target(), 0U);
    EXPECT_FALSE(tracker.camera());
}

TEST(FrameTracker, WhatADisplayListRecordsDoesNotHappen) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    fixed.project(kLens);
    tracker.compileList(true);
    fixed.project(ortho());
    EXPECT_FALSE(tracker.draw(10));
    tracker.compileList(false);
    tracker.endFrame();
    EXPECT_FALSE(tracker.camera());
    EXPECT_EQ(tracker.lastFrame().flat_draws, 0U);
}

TEST(FrameTracker, OpenGlsOwnDepthOfTheStackIsBelieved) {
    const Matrix view = product(turn(20), translation(0, -1, -9));
    FrameTracker tracker;
    Fixed fixed(tracker);
    for (int i = 0; i < 3; ++i) {  // pushes whose pops nobody saw
        fixed.model(translation(static_cast<float>(i), 7, 7));
        fixed.push();
    }
    EXPECT_EQ(tracker.stackDepth(), 3U);
    tracker.stackIs(1);
    fixed.project(kLens);
    fixed.model(view);
    fixed.push();
    (void)fixed.draw(100);
    ASSERT_TRUE(tracker.camera());
    EXPECT_EQ(tracker.camera()->view_source, "lowest model-view matrix on the stack");
    EXPECT_NEAR(tracker.camera()->view[14], view[14], 1e-4F);
    fixed.pop();
    fixed.pop();
    fixed.pop();  // an error, which OpenGL takes no harm from
    EXPECT_EQ(tracker.stackDepth(), 0U);
    for (int i = 0; i < 200; ++i) {
        fixed.push();
    }
    EXPECT_EQ(tracker.stackDepth(), 200U);
}

TEST(FrameTracker, AProgramThatIsLinkedAnewOrDeletedHasNoCamera) {
    FrameTracker tracker;
    const auto frame = [&](std::uint32_t program) {
        tracker.useProgram(program);
        (void)tracker.draw(10);
        tracker.endFrame();
        return !tracker.lastFrame().lenses.empty();
    };
    tracker.uniform(3, 0, kLens, UniformName::Unknown);
    EXPECT_TRUE(frame(3));
    tracker.programLinked(3);
    EXPECT_FALSE(frame(3)) << "its uniforms are zero";
    tracker.uniform(3, 0, kLens, UniformName::Unknown);
    EXPECT_TRUE(frame(3));
    tracker.programDeleted(3);
    EXPECT_TRUE(frame(3)) << "in use, it lives on";
    EXPECT_FALSE(frame(0));
    EXPECT_FALSE(frame(3)) << "another one of that name";
    tracker.uniform(4, 0, kLens, UniformName::Unknown);
    tracker.programDeleted(4);
    EXPECT_FALSE(frame(4));
}

TEST(FrameTracker, AFramebufferThatIsDeletedIsBoundNoMore) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    fixed.project(kLens);
    for (int frame = 0; frame < 2; ++frame) {
        (void)tracker.bindFramebuffer(4);
        (void)fixed.draw(100);
        tracker.endFrame();
    }
    EXPECT_EQ(tracker.target(), 4U);
    tracker.framebufferDeleted(4);
    EXPECT_EQ(tracker.framebuffer(), 0U);
    EXPECT_EQ(tracker.target(), 0U);
    EXPECT_TRUE(tracker.camera());
    EXPECT_FALSE(tracker.sceneSeen()) << "that camera is of the frame before";
    (void)fixed.draw(100);
    EXPECT_TRUE(tracker.sceneSeen());
    tracker.endFrame();
    EXPECT_FALSE(tracker.lastFrame().lenses.empty());
    (void)tracker.bindFramebuffer(5);
    tracker.framebufferDeleted(6);
    EXPECT_EQ(tracker.framebuffer(), 5U);
}

TEST(FrameTracker, AListThatChangesTheMatrixModeIsKnown) {
    FrameTracker tracker;
    tracker.matrixMode(true, false);
    EXPECT_FALSE(tracker.listsChangeMode());
    tracker.compileList(true);
    tracker.matrixMode(false, true);
    tracker.compileList(false);
    EXPECT_TRUE(tracker.listsChangeMode());
}

TEST(FrameTracker, TheProfileHasTheLastWord) {
    FrameTracker tracker({.route = CameraRoute::FixedFunction,
                          .overlay = OverlaySwitch::First,
                          .view = ViewRule::Identity,
                          .near_plane = 0.5,
                          .far_plane = std::nullopt});
    Fixed fixed(tracker);
    tracker.uniform(3, 0, frustum(-1, 1, -1, 1, 1, 10), UniformName::Unknown);
    tracker.useProgram(3);
    fixed.project(kLens);
    fixed.model(translation(0, 0, -5));
    (void)fixed.draw(10);
    fixed.project(ortho());
    EXPECT_TRUE(fixed.draw(4));
    ASSERT_TRUE(tracker.camera());
    EXPECT_EQ(tracker.camera()->lens.near_plane, 0.5);
    EXPECT_NEAR(tracker.camera()->lens.far_plane, 512, 5);
    EXPECT_EQ(tracker.camera()->view, kIdentity);
}

TEST(FrameTracker, AMatrixThatIsWrittenOnceIsReadAgainWhenTheRulesOfDepthChange) {
    FrameTracker tracker;
    tracker.useProgram(1);
    tracker.uniform(1, 0, kLens, UniformName::Unknown);
    tracker.depth({.range_reversed = true});
    (void)tracker.draw(10);
    ASSERT_TRUE(tracker.camera());
    EXPECT_TRUE(tracker.camera()->lens.reversed);
}

TEST(Refusal, NamesReversedDepthOneEyeOfStereoAndTheMissingCamera) {
    FoundCamera camera;
    camera.lens = {.near_plane = 0.1, .far_plane = 50};
    EXPECT_EQ(refusal(camera, {}), "");
    EXPECT_EQ(refusal(camera, {.stereo = true, .draw_buffer = 0x0405}), "") << "GL_BACK: the same for both eyes";
    EXPECT_EQ(refusal(camera, {.stereo = false, .draw_buffer = 0x0402}), "");
    EXPECT_NE(refusal(camera, {.stereo = true, .draw_buffer = 0x0402}).find("stereo: "), std::string::npos);
    camera.lens.reversed = true;
    EXPECT_NE(refusal(camera, {}).find("reversed depth: near 0.1 lies at window depth 1"), std::string::npos);
    EXPECT_EQ(noCamera(299, {}), "");
    FrameSummary flat;
    flat.flat_draws = 7;
    EXPECT_NE(noCamera(300, flat).find("in 300 frames, 7 orthographic or flat draws"), std::string::npos);
    EXPECT_EQ(noCamera(301, flat), "") << "it is said once";
}

// Who never says glMatrixMode has gluPerspective, glTranslatef and the turn of the object in one matrix.
TEST(FrameTracker, APerspectiveInTheModelViewMatrixIsOneToo) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    const Matrix view = product(kLens, translation(0, 0, -5));
    for (int frame = 0; frame < 3; ++frame) {
        fixed.model(ortho());  // stars behind it
        EXPECT_FALSE(fixed.draw(4));
        fixed.model(product(view, turn(30)));
        EXPECT_FALSE(fixed.draw(100));
        fixed.model(product(view, turn(60)));
        EXPECT_FALSE(fixed.draw(100));
        fixed.model(ortho());  // and words before it
        EXPECT_EQ(fixed.draw(4), frame > 0) << frame;
        tracker.endFrame();
    }
    const std::optional<FoundCamera> camera = tracker.camera();
    ASSERT_TRUE(camera);
    EXPECT_EQ(camera->source, "perspective in the model-view matrix");
    EXPECT_NEAR(camera->lens.near_plane, 0.1, 1e-3);
    EXPECT_NEAR(camera->view[14], -5, 1e-3);
    EXPECT_NEAR(camera->view[0], turn(30)[0], 1e-4);
    EXPECT_EQ(tracker.lastFrame().lenses.size(), 1U);
    EXPECT_EQ(tracker.lastFrame().flat_draws, 2U);
}

// A shooter of today: the level in a framebuffer of its own, its picture on the screen, and the hero's face over it.
TEST(FrameTracker, AFaceInTheCornerOfTheScreenIsNoScene) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    double share = 1.0;
    tracker.viewportBy([&] { return share; });
    std::vector<bool> moments;
    for (int frame = 0; frame < 3; ++frame) {
        moments.clear();
        share = 1.0;
        (void)tracker.bindFramebuffer(7);
        fixed.project(kLens);
        EXPECT_FALSE(fixed.draw(9000));
        moments.push_back(tracker.bindFramebuffer(0));
        fixed.project(ortho());
        moments.push_back(fixed.draw(4));
        share = 0.01;
        fixed.project(frustum(-1, 1, -1, 1, 4, 2048));
        moments.push_back(fixed.draw(1191));
        EXPECT_EQ(tracker.camera().has_value(), frame > 0) << "the face is never the camera";
        tracker.endFrame();
    }
    EXPECT_EQ(tracker.target(), 7U);
    EXPECT_EQ(moments, (std::vector<bool>{true, false, false}));
    ASSERT_TRUE(tracker.camera());
    EXPECT_NEAR(tracker.camera()->lens.near_plane, 0.1, 1e-3);
}

TEST(FrameTracker, APictureInACornerComesAfterTheFluidAndIsTheSceneOnlyWhereThereIsNoOther) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    double share = 0.05;
    tracker.viewportBy([&] { return share; });
    fixed.project(frustum(-1, 1, -1, 1, 4, 2048));
    EXPECT_FALSE(fixed.draw(5000));
    tracker.endFrame();
    ASSERT_TRUE(tracker.camera());
    EXPECT_NEAR(tracker.camera()->lens.near_plane, 4, 1e-2);
    for (int frame = 0; frame < 3; ++frame) {
        share = 1.0;
        fixed.project(kLens);
        EXPECT_FALSE(fixed.draw(100));
        share = 0.05;
        fixed.project(frustum(-1, 1, -1, 1, 4, 2048));
        EXPECT_EQ(fixed.draw(5000), frame > 1) << frame;
        tracker.endFrame();
    }
    EXPECT_NEAR(tracker.camera()->lens.near_plane, 0.1, 1e-3);
}

TEST(FrameTracker, AFaceWithTheLensOfTheLevelIsNoneOfIt) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    double share = 1.0;
    tracker.viewportBy([&] { return share; });
    std::vector<bool> moments;
    for (int frame = 0; frame < 3; ++frame) {
        share = 1.0;
        fixed.project(kLens);
        EXPECT_FALSE(fixed.draw(100));
        share = 0.01;
        moments.push_back(fixed.draw(1191));
        tracker.endFrame();
    }
    EXPECT_EQ(moments, (std::vector<bool>{false, false, true}));
    EXPECT_EQ(tracker.lastFrame().flat_draws, 1U);
    ASSERT_TRUE(tracker.camera());
    EXPECT_EQ(tracker.camera()->vertices, 100U);
}

// An intro that fills the window, then a game that leaves most of it to its panels.
TEST(FrameTracker, AfterManyFramesWithoutAnySceneAPictureInACornerIsOne) {
    for (const std::uint32_t intro_in : {0U, 7U}) {
        FrameTracker tracker;
        Fixed fixed(tracker);
        double share = 1.0;
        tracker.viewportBy([&] { return share; });
        const auto frame = [&](std::uint32_t into, double of_window, const Matrix& lens) {
            share = of_window;
            (void)tracker.bindFramebuffer(into);
            fixed.project(lens);
            (void)fixed.draw(500);
            (void)tracker.bindFramebuffer(0);
            tracker.endFrame();
        };
        const auto near_plane = [&] { return tracker.camera() ? tracker.camera()->lens.near_plane : 0.0; };
        frame(intro_in, 1.0, kLens);
        frame(intro_in, 1.0, kLens);
        EXPECT_NEAR(near_plane(), 0.1, 1e-3);
        const Matrix game = frustum(-1, 1, -1, 1, 4, 2048);
        for (int i = 0; i < 100; ++i) {
            frame(0, 0.1, game);
            frame(0, 1.0, ortho());  // which says nothing
        }
        EXPECT_NEAR(near_plane(), 0.1, 1e-3) << "of framebuffer " << intro_in << ", as long as it may come back";
        for (int i = 0; i < 21; ++i) {
            frame(0, 0.1, game);
        }
        EXPECT_NEAR(near_plane(), 4, 1e-2) << "after framebuffer " << intro_in;
        EXPECT_EQ(tracker.target(), 0U);
    }
}

// Irrlicht: the eye looks along +z, and view and world are made for that.
TEST(FrameTracker, ALeftHandedCameraIsOneAndTheViewOfAMirrorIsNone) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    Matrix hand = kIdentity;
    hand[10] = -1;
    const Matrix view = product(turn(30), translation(1, 2, 7));
    fixed.project(product(kLens, hand));
    fixed.model(view);
    (void)fixed.draw(100);
    ASSERT_TRUE(tracker.camera());
    const FoundCamera camera = *tracker.camera();
    EXPECT_EQ(camera.source, "projection matrix");
    // What it shows of a point is what the program shows of it, with the world's z turned round.
    const Matrix ours = product(product(projectionOf(camera.lens), camera.view), hand);
    const Matrix theirs = product(product(kLens, hand), view);
    for (std::size_t i = 0; i < ours.size(); ++i) {
        EXPECT_NEAR(ours.at(i), theirs.at(i), 1e-3) << i;
    }
    EXPECT_EQ(readMatrix(product(product(kLens, hand), view)).reason, "it is mirrored");
}

TEST(FrameTracker, AFrameWithoutPerspectiveKeepsTheLastCamera) {
    FrameTracker tracker;
    Fixed fixed(tracker);
    fixed.project(kLens);
    (void)fixed.draw(10);
    tracker.endFrame();
    fixed.project(ortho());
    EXPECT_FALSE(fixed.draw(10));
    tracker.endFrame();
    EXPECT_TRUE(tracker.camera());
}

}  // namespace
}  // namespace sluice::inject::test
