// SPDX-License-Identifier: MIT
// Where the water stands.
#include "payload/placement.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "matrices.hpp"

namespace sluice::inject::test {
namespace {

std::array<double, 3> transform(const Matrix& m, const Triple& p) {
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) {
        out.at(i) = double{m.at(i)} * double{p[0]} + double{m.at(4 + i)} * double{p[1]} +
                    double{m.at(8 + i)} * double{p[2]} + double{m.at(12 + i)};
    }
    return out;
}

FoundCamera cameraWith(const Matrix& view) {
    FoundCamera camera;
    camera.lens = readMatrix(frustum(-1, 1, -1, 1, 5, 60)).lens;
    camera.view = view;
    return camera;
}

TEST(Placement, TheBoxStandsUprightAtTheDistanceOfWhatIsSeen) {
    const FoundCamera first = cameraWith(product(turn(40), translation(3, -2, -40)));
    WaterPlan plan;
    plan.low = {0, 0, 0};
    plan.high = {2, 1, 1};
    const Placement placement(plan, first, 40.0);
    const PlacedCamera placed = placement.camera(first);
    const auto centre = transform(placed.view, {1, 0.5F, 0.5F});
    EXPECT_NEAR(centre[0], 0, 1e-3);
    EXPECT_NEAR(centre[1], 0, 1e-3);
    EXPECT_NEAR(centre[2] * placement.unitsPerMetre(), -40, 1e-2);
    const auto above = transform(placed.view, {1, 1.5F, 0.5F});
    EXPECT_NEAR(above[1] - centre[1], 1, 1e-4);  // this eye is level
    // The box spans three fifths of the picture: x of its side over distance, times the cotangent.
    EXPECT_NEAR(1.0 / -centre[2] * first.lens.scale_x, 0.6, 1e-3);
}

TEST(Placement, TheBoxStaysWhereItIsWhenTheEyeMoves) {
    const FoundCamera first = cameraWith(translation(0, 0, -10));
    const Placement placement({}, first, 10.0);
    const FoundCamera later = cameraWith(product(turn(90), translation(0, 0, -4)));
    const Matrix moved = placement.camera(later).view;
    const auto eye = transform(moved, {0, 0, 0});
    // The box's middle is the world's origin, four units before an eye that has turned by ninety degrees.
    EXPECT_NEAR(eye[0] * placement.unitsPerMetre(), -4, 1e-3);
    EXPECT_NEAR(eye[2] * placement.unitsPerMetre(), 0, 1e-3);
}

TEST(Placement, InTheWorldOnlyTheUnitChanges) {
    WaterPlan plan;
    plan.in_view = false;
    plan.units_per_metre = 10;
    const FoundCamera camera = cameraWith(translation(0, 0, -20));
    const PlacedCamera placed = Placement(plan, camera, 3.0).camera(camera);
    EXPECT_NEAR(placed.view[14], -2, 1e-5F);
    const Reading lens = readMatrix(placed.projection);
    EXPECT_NEAR(lens.lens.near_plane, 0.5, 1e-4);
    EXPECT_NEAR(lens.lens.far_plane, 6, 1e-2);
}

TEST(Placement, AProgramWhoseUpIsZGetsItsWaterUprightToo) {
    Matrix look_along_y = kIdentity;  // eye y is world z
    look_along_y[5] = look_along_y[10] = 0;
    look_along_y[6] = -1;
    look_along_y[9] = 1;
    WaterPlan plan;
    plan.up = {0, 0, 1};
    const FoundCamera camera = cameraWith(look_along_y);
    const Matrix view = Placement(plan, camera, 10.0).camera(camera).view;
    EXPECT_NEAR(view[5], 1, 1e-5F);
}

TEST(Placement, WhichWayIsUpIsSeenFromHowTheEyeStands) {
    const Triple y{0, 1, 0};
    const Triple z{0, 0, 1};
    Matrix spin = kIdentity;  // about +z
    spin[0] = spin[5] = 0.8F;
    spin[1] = 0.6F;
    spin[4] = -0.6F;
    EXPECT_EQ(upOf(kIdentity), y);
    EXPECT_EQ(upOf(product(pitch(30), turn(50))), y) << "from above, over a ground of x and z";
    EXPECT_EQ(upOf(product(pitch(40), turn(180))), y) << "straight along z";
    EXPECT_EQ(upOf(product(pitch(-70), spin)), z) << "from above, over a ground of x and y";
    EXPECT_EQ(upOf(product(pitch(-30), spin)), z);
    EXPECT_EQ(upOf(pitch(-70)), z) << "straight along y";
    EXPECT_EQ(upOf(spin), y) << "a picture that turns in its plane";
    const FoundCamera camera = cameraWith(product(pitch(-90), spin));
    WaterPlan plan;
    EXPECT_EQ(Placement(plan, camera, 10.0).up(), z);
    plan.up = y;
    EXPECT_EQ(Placement(plan, camera, 10.0).up(), y) << "as the profile says";
}

}  // namespace
}  // namespace sluice::inject::test
