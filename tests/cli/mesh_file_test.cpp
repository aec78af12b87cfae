// SPDX-License-Identifier: MIT
// OBJ files of the simulation's meshes: what is read, and what is refused.
#include "app/mesh_files.hpp"

#include <gmock/gmock.h>

namespace sluice::cli {
namespace {

using ::testing::HasSubstr;

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.2 0\n";

std::string refusal(const std::string& text) {
    const Result<simulator::Mesh> mesh = parseObj(text, "m.obj");
    return mesh.ok() ? "" : mesh.error().message();
}

TEST(MeshFile, CornersAndFacesAreReadAndFacesOfMoreCornersAreCut) {
    const Result<simulator::Mesh> mesh = parseObj("# a comment\nmtllib none.mtl\no square\nusemtl red\n" + kCorners +
                                                      "vn 0 0 1\nf 1//1 2//1 3//1 4//1\nf -5 -3 -4\n",
                                                  "m.obj");
    ASSERT_TRUE(mesh.ok()) << mesh.error().message();
    ASSERT_EQ(mesh.value().corners.size(), 5U);
    EXPECT_EQ(mesh.value().corners[4], (std::array<double, 3>{0.5, 0.2, 0}));
    ASSERT_EQ(mesh.value().triangles.size(), 3U);
    EXPECT_EQ(mesh.value().triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
    EXPECT_EQ(mesh.value().triangles[2], (std::array<std::uint32_t, 3>{0, 2, 1}));
    EXPECT_TRUE(parseObj("", "m.obj").value().triangles.empty());  // refused with the other meshes without triangles
}

TEST(MeshFile, WhatIsNoCornerOrNoFaceIsNamed) {
    EXPECT_THAT(refusal(kCorners + "v 1 two 3\n"),
                HasSubstr("m.obj: line 6: expected a corner of three finite numbers, found \"v 1 two 3\""));
    EXPECT_THAT(refusal("v 1 nan 3\n"), HasSubstr("line 1: expected a corner"));
    EXPECT_THAT(refusal("v 1 2\n"), HasSubstr("line 1: expected a corner"));
    EXPECT_THAT(refusal("v 1 2 1e999\n"), HasSubstr("line 1: expected a corner"));
    EXPECT_THAT(refusal(kCorners + "f 1 2 6\n"), HasSubstr("face 1 has corner 6, of 5"));
    EXPECT_THAT(refusal(kCorners + "f 0 1 2\n"), HasSubstr("m.obj: is not an OBJ file"));
    EXPECT_THAT(refusal(kCorners + "f 2 3 4 1 5\n"), HasSubstr("face 1 of 5 corners is not convex"));
}

}  // namespace
}  // namespace sluice::cli
