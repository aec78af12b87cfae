// SPDX-License-Identifier: MIT
// Cameras out of matrices.
#include "tracker/projection.hpp"

#include <gtest/gtest.h>

#include "matrices.hpp"

namespace sluice::inject::test {
namespace {

void expectSame(const Matrix& a, const Matrix& b, float tolerance = 1e-4F) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_NEAR(a.at(i), b.at(i), tolerance) << i;
    }
}

TEST(Projection, AFrustumGivesItsPlanesBackAndIsPure) {
    const Reading reading = readMatrix(frustum(-1, 1, -1, 1, 5, 60));
    ASSERT_EQ(reading.shape, Shape::Perspective) << reading.reason;
    EXPECT_TRUE(reading.pure);
    EXPECT_NEAR(reading.lens.near_plane, 5, 1e-4);
    EXPECT_NEAR(reading.lens.far_plane, 60, 1e-3);
    EXPECT_NEAR(reading.lens.scale_x, 5, 1e-5);
    expectSame(projectionOf(reading.lens), frustum(-1, 1, -1, 1, 5, 60));
}

TEST(Projection, AnAsymmetricFrustumKeepsItsShift) {
    const Matrix matrix = frustum(-0.5, 1.5, -1, 0.25, 0.1, 151);
    const Reading reading = readMatrix(matrix);
    ASSERT_EQ(reading.shape, Shape::Perspective) << reading.reason;
    expectSame(projectionOf(reading.lens), matrix);
}

TEST(Projection, ProjectionTimesModelViewComesApartIntoLensAndRigidView) {
    const Matrix view = product(turn(35), translation(1, -2, -7));
    const Reading reading = readMatrix(product(frustum(-0.1, 0.1, -0.075, 0.075, 0.1, 512), view));
    ASSERT_EQ(reading.shape, Shape::Perspective) << reading.reason;
    EXPECT_FALSE(reading.pure);
    EXPECT_NEAR(reading.lens.near_plane, 0.1, 1e-3);
    EXPECT_NEAR(reading.scale, 1, 1e-4);
    expectSame(reading.view, view, 1e-3F);
}

TEST(Projection, TheScaleOfAModelIsTakenOutOfTheViewAndLeavesThePlanesAlone) {
    const Matrix model_view = product(translation(0, 0, -20), scaling(3));
    const Reading reading = readMatrix(product(frustum(-1, 1, -1, 1, 2, 100), model_view));
    ASSERT_EQ(reading.shape, Shape::Perspective) << reading.reason;
    EXPECT_NEAR(reading.lens.near_plane, 2, 1e-3);
    EXPECT_NEAR(reading.scale, 3, 1e-4);
    expectSame(reading.view, translation(0, 0, -20), 1e-3F);
}

TEST(Projection, AnInfiniteFarPlaneGetsAFiniteOne) {
    Matrix matrix = frustum(-1, 1, -1, 1, 2, 100);
    matrix[10] = -1;
    matrix[14] = -4;
    const Reading reading = readMatrix(matrix);
    ASSERT_EQ(reading.shape, Shape::Perspective) << reading.reason;
    EXPECT_NEAR(reading.lens.near_plane, 2, 1e-5);
    EXPECT_NEAR(reading.lens.far_plane, 2 * kFarOfInfinite, 1);
}

TEST(Projection, WhatIsAffineIsFlat) {
    EXPECT_EQ(readMatrix(ortho()).shape, Shape::Flat);
    EXPECT_EQ(readMatrix(kIdentity).shape, Shape::Flat);
}

TEST(Projection, WhatIsNoCameraIsRejectedWithItsReason) {
    const auto reason = [](Matrix m) {
        const Reading reading = readMatrix(m);
        EXPECT_EQ(reading.shape, Shape::Rejected);
        return reading.reason;
    };
    EXPECT_NE(reason(Matrix{}), "");
    Matrix broken = kIdentity;
    broken[3] = std::nanf("");
    EXPECT_EQ(reason(broken), "it is not finite");
    Matrix behind = frustum(-1, 1, -1, 1, 2, 100);
    behind[14] = 4;
    EXPECT_NE(reason(behind).find("near plane would lie at -"), std::string::npos);
    Matrix reversed = frustum(-1, 1, -1, 1, 2, 100);
    reversed[10] = 0.5F;
    reversed[14] = 1;
    EXPECT_NE(reason(reversed).find("plane"), std::string::npos);
    Matrix oblique = frustum(-1, 1, -1, 1, 2, 100);
    oblique[2] = 0.3F;
    EXPECT_NE(reason(oblique).find("oblique"), std::string::npos);
    EXPECT_EQ(reason(product(frustum(-1, 1, -1, 1, 2, 100),
                             [] {
                                 Matrix mirror = kIdentity;
                                 mirror[0] = -1;
                                 return mirror;
                             }())),
              "it is mirrored");
}

/// As glClipControl(GL_ZERO_TO_ONE) wants it: the planes at 0 and 1, or, reversed, at 1 and 0.
Matrix zeroToOne(Matrix m, bool reversed) {
    for (std::size_t column = 0; column < 4; ++column) {
        const float z = reversed ? -m.at(4 * column + 2) : m.at(4 * column + 2);
        m.at(4 * column + 2) = 0.5F * (z + m.at(4 * column + 3));
    }
    return m;
}

TEST(Projection, DepthFromZeroToOneHasTheSamePlanes) {
    const Matrix lens = frustum(-1, 1, -1, 1, 2, 100);
    const Reading reading = readMatrix(zeroToOne(lens, false), {.zero_to_one = true});
    ASSERT_EQ(reading.shape, Shape::Perspective) << reading.reason;
    EXPECT_NEAR(reading.lens.near_plane, 2, 1e-4);
    EXPECT_NEAR(reading.lens.far_plane, 100, 1e-2);
    EXPECT_FALSE(reading.lens.reversed);
    expectSame(projectionOf(reading.lens), lens);
    expectSame(projectionOf(reading.lens, true), zeroToOne(lens, false));
}

TEST(Projection, ReversedDepthIsKnownByItsPlanesItsRangeAndItsFarPlaneAtInfinity) {
    const Matrix lens = frustum(-1, 1, -1, 1, 2, 100);
    const Reading upside_down = readMatrix(zeroToOne(lens, true), {.zero_to_one = true, .greater = true});
    ASSERT_EQ(upside_down.shape, Shape::Perspective) << upside_down.reason;
    EXPECT_TRUE(upside_down.lens.reversed);
    EXPECT_NEAR(upside_down.lens.near_plane, 2, 1e-4);
    EXPECT_NEAR(upside_down.lens.far_plane, 100, 1e-2);
    EXPECT_TRUE(readMatrix(lens, {.range_reversed = true}).lens.reversed);
    EXPECT_FALSE(readMatrix(zeroToOne(lens, true), {.zero_to_one = true, .range_reversed = true}).lens.reversed);
    Matrix endless = frustum(-1, 1, -1, 1, 2, 100);
    endless[10] = 0;
    endless[14] = 2;
    const Reading infinite = readMatrix(endless, {.zero_to_one = true});
    ASSERT_EQ(infinite.shape, Shape::Perspective) << infinite.reason;
    EXPECT_TRUE(infinite.lens.reversed);
    EXPECT_NEAR(infinite.lens.near_plane, 2, 1e-5);
    EXPECT_NEAR(infinite.lens.far_plane, 2 * kFarOfInfinite, 1);
    // Where nothing speaks for it, such a matrix is something else.
    EXPECT_EQ(readMatrix(zeroToOne(lens, true)).shape, Shape::Rejected);
}

TEST(Projection, EitherWayOfWritingGivesTheSameCamera) {
    const Matrix view = product(turn(35), translation(1, -2, -7));
    for (const double near : {0.05, 0.1, 0.5, 2.0}) {
        const Matrix lens = frustum(-0.7 * near, 0.7 * near, -0.5 * near, 0.5 * near, near, 512);
        for (const Matrix& matrix : {lens, product(lens, view)}) {
            const Reading columns = readEitherWay(matrix);
            const Reading rows = readEitherWay(transposed(matrix));
            ASSERT_EQ(columns.shape, Shape::Perspective) << columns.reason;
            ASSERT_EQ(rows.shape, Shape::Perspective) << rows.reason;
            EXPECT_FALSE(columns.transposed);
            EXPECT_TRUE(rows.transposed) << near;
            EXPECT_TRUE(sameLens(columns.lens, rows.lens));
            expectSame(columns.view, rows.view);
        }
    }
    EXPECT_EQ(readEitherWay(ortho()).shape, Shape::Flat);
}

TEST(Projection, RigidPartTakesOneScaleOutAndRefusesTheRest) {
    const Rigid rigid = rigidPart(product(turn(20), product(translation(1, 2, 3), scaling(2))));
    ASSERT_TRUE(rigid.valid);
    EXPECT_NEAR(rigid.scale, 2, 1e-5);
    expectSame(rigid.matrix, product(turn(20), translation(1, 2, 3)));
    Matrix uneven = kIdentity;
    uneven[0] = 2;
    EXPECT_FALSE(rigidPart(uneven).valid);
}

}  // namespace
}  // namespace sluice::inject::test
