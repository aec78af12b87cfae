// SPDX-License-Identifier: MIT
// Every way of writing a scene wrongly that has been thought of, and the exact message that it gets.
#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "sluice/scene/scene.hpp"

namespace sluice::scene {
namespace {

struct BadScene {
    const char* name;
    const char* text;
    const char* message;
};

void PrintTo(const BadScene& bad, std::ostream* out) {
    *out << bad.text;
}

class ABadScene : public ::testing::TestWithParam<BadScene> {};

TEST(BadScene, AMemberIsToldWhatItNeedsAndNotWhatItMayLeaveOut) {
    const auto scene = parseScene(R"({"simulation": {"emitters": [{"shape": "disc", "centre": [0,1,0],
                                      "direction": [0,1,0], "width": 1, "speed": 1}]}})",
                                  "s.json");
    ASSERT_FALSE(scene.ok());
    EXPECT_EQ(scene.error().detail, "/simulation/emitters/0/height: missing");
    EXPECT_EQ(scene.error().remedy, "every member of this list needs: shape, centre, direction, width, height, speed");
}

TEST_P(ABadScene, GetsThisMessage) {
    const Result<Scene> scene = parseScene(GetParam().text, "s.json");
    ASSERT_FALSE(scene.ok());
    EXPECT_EQ(scene.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(scene.error().thing, "s.json");
    EXPECT_EQ(scene.error().detail, GetParam().message);
}

constexpr BadScene kBadScenes[] = {
    {"List", "[]", "expected a JSON object, found a JSON array"},
    {"Number", "7", "expected a JSON object, found a JSON number"},
    {"UnknownTop", R"({"fluids": 1})", R"(/fluids: unknown key with value 1; the nearest known key is "fluid")"},
    {"UnknownFluid", R"({"fluid": {"absorbtion": [1,2,3]}})",
     R"(/fluid/absorbtion: unknown key with value [1,2,3]; the nearest known key is "absorption")"},
    {"UnknownCamera", R"({"camera": {"fov": 40}})",
     R"(/camera/fov: unknown key with value 40; the nearest known key is "vertical_fov_degrees")"},
    {"UnknownTransform", R"({"particles": {"transform": {"scales": 2}}})",
     R"(/particles/transform/scales: unknown key with value 2; the nearest known key is "scale")"},
    {"ParticlesString", R"({"particles": "p.pos"})", R"(/particles: expected an object, found "p.pos")"},
    {"PathNumber", R"({"particles": {"path": 3}})", "/particles/path: expected a string, found 3"},
    {"RadiusNegative", R"({"particles": {"radius": -1}})",
     "/particles/radius: expected a number in [0, 1000000], found -1"},
    {"ScaleZero", R"({"particles": {"transform": {"scale": 0}}})",
     "/particles/transform/scale: expected a number > 0 and at most 1000000, found 0"},
    {"TranslateShort", R"({"particles": {"transform": {"translate": [1, 2]}}})",
     "/particles/transform/translate: expected a list of 3 numbers, found [1,2]"},
    {"TranslateWord", R"({"particles": {"transform": {"translate": [1, "2", 3]}}})",
     R"(/particles/transform/translate/1: expected a number in [-1000000, 1000000], found "2")"},
    {"FovZero", R"({"camera": {"vertical_fov_degrees": 0}})",
     "/camera/vertical_fov_degrees: expected a number in [1, 170], found 0"},
    {"FovNull", R"({"camera": {"vertical_fov_degrees": null}})",
     "/camera/vertical_fov_degrees: expected a number in [1, 170], found null"},
    {"NearZero", R"({"camera": {"near": 0}})", "/camera/near: expected a number > 0 and at most 1000000, found 0"},
    {"FarBeforeNear", R"({"camera": {"near": 2, "far": 1}})",
     "/camera/far: expected a number > near, which is 2, found 1"},
    {"TargetAtPosition", R"({"camera": {"position": [1,2,3], "target": [1,2,3]}})",
     "/camera/target: expected a point other than position, found [1, 2, 3]"},
    {"UpAlongView", R"({"camera": {"position": [0,5,0], "target": [0,0,0]}})",
     "/camera/up: expected a direction that is not along the view, found [0, 1, 0]"},
    {"UpZero", R"({"camera": {"up": [0,0,0]}})",
     "/camera/up: expected a direction that is not along the view, found [0, 0, 0]"},
    {"SunZero", R"({"sky": {"to_sun": [0,0,0]}})", "/sky/to_sun: expected a direction of length > 0, found [0, 0, 0]"},
    {"ZenithNegative", R"({"sky": {"zenith": [0,-0.5,0]}})",
     "/sky/zenith/1: expected a number in [0, 1000000], found -0.5"},
    {"EnvironmentObject", R"({"environment": {"path": "x"}})", "/environment: expected a string, found an object"},
    {"IorOne", R"({"fluid": {"index_of_refraction": 1}})",
     "/fluid/index_of_refraction: expected a number in (1, 4], found 1"},
    {"FilterUnknown", R"({"fluid": {"filter": "gauss"}})",
     R"(/fluid/filter: expected one of "none", "narrow_range", found "gauss")"},
    {"FilterNumber", R"({"fluid": {"filter": 1}})",
     R"(/fluid/filter: expected one of "none", "narrow_range", found 1)"},
    {"ViewUnknown", R"({"fluid": {"view": "color"}})",
     R"(/fluid/view: expected one of "fluid", "depth", "normal", "thickness", "echo", found "color")"},
    {"IterationsMany", R"({"fluid": {"filter_iterations": 17}})",
     "/fluid/filter_iterations: expected a whole number in [0, 16], found 17"},
    {"IterationsFraction", R"({"fluid": {"filter_iterations": 2.5}})",
     "/fluid/filter_iterations: expected a whole number in [0, 16], found 2.5"},
    {"IterationsNegative", R"({"fluid": {"filter_iterations": -1}})",
     "/fluid/filter_iterations: expected a whole number in [0, 16], found -1"},
    {"ThicknessScale", R"({"fluid": {"thickness_scale": 0.75}})",
     "/fluid/thickness_scale: expected one of 1, 0.5, 0.25, found 0.75"},
    {"RefractionNumber", R"({"fluid": {"refraction": 1}})", "/fluid/refraction: expected true or false, found 1"},
    {"AbsorptionHuge", R"({"fluid": {"absorption": [1e300, 0, 0]}})",
     "/fluid/absorption/0: expected a number in [0, 1000000], found 1e+300"},
    {"PillarsObject", R"({"engine": {"pillars": {}}})", "/engine/pillars: expected a list of objects, found an object"},
    {"PillarNumber", R"({"engine": {"pillars": [3]}})", "/engine/pillars/0: expected an object, found 3"},
    {"PillarIncomplete", R"({"engine": {"pillars": [{"base": [0,0,0], "radius": 1}]}})",
     "/engine/pillars/0/height: missing"},
    {"PillarMisspelt", R"({"engine": {"pillars": [{"base": [0,0,0], "radius": 1, "hight": 1}]}})",
     R"(/engine/pillars/0/hight: unknown key with value 1; the nearest known key is "height")"},
    {"CrateFlat", R"({"engine": {"crates": [{"centre": [0,0,0], "size": 0, "turn_degrees": 0}]}})",
     "/engine/crates/0/size: expected a number > 0 and at most 1000000, found 0"},
    {"AmbientBright", R"({"engine": {"ambient": [2,0,0]}})", "/engine/ambient/0: expected a number in [0, 1], found 2"},
    {"DomainFlat", R"({"simulation": {"domain": {"low": [-1, 2, -1]}}})",
     "/simulation/domain/high/1: expected a number > low, which is 2, found 2"},
    {"FluidOutside", R"({"simulation": {"fluid": [{"low": [0,0,0], "high": [2,1,1], "velocity": [0,0,0]}]}})",
     "/simulation/fluid/0: expected a box within the domain, [-1, 0, -1] to [1, 2, 1], found [0, 0, 0] to [2, 1, 1]"},
    {"FluidTwice",
     R"({"simulation": {"fluid": [{"low": [0,0,0], "high": [1,1,1], "velocity": [0,0,0]},
                                  {"low": [-1,0,-1], "high": [0.5,1,1], "velocity": [0,0,0]}]}})",
     "/simulation/fluid/1: expected a box that does not overlap fluid/0, found [-1, 0, -1] to [0.5, 1, 1]"},
    {"FluidUnknown",
     R"({"simulation": {"fluid": [{"low": [0,0,0], "high": [1,1,1], "velocity": [0,0,0], "fluid": 1}]}})",
     "/simulation/fluid/0/fluid: expected a place in simulation/fluids, which has 0, found 1"},
    {"FluidWithoutColour",
     R"({"simulation": {"fluids": [{"density": 1, "viscosity": 0, "tension": 0, "adhesion": 0}]}})",
     "/simulation/fluids/0/colour: missing"},
    {"PlaneWithoutNormal", R"({"simulation": {"planes": [{"normal": [0,0,0], "through": [0,0,0]}]}})",
     "/simulation/planes/0/normal: expected a direction of length > 0, found [0, 0, 0]"},
    {"EmitterWithoutDirection",
     R"({"simulation": {"emitters": [{"shape": "disc", "centre": [0,1,0], "direction": [0,0,0], "width": 1,
                                      "height": 1, "speed": 1, "rate": 0, "start": 0, "stop": 0}]}})",
     "/simulation/emitters/0/direction: expected a direction of length > 0, found [0, 0, 0]"},
    {"EmitterOval",
     R"({"simulation": {"emitters": [{"shape": "disc", "centre": [0,1,0], "direction": [0,1,0], "width": 1,
                                      "height": 2, "speed": 1, "rate": 0, "start": 0, "stop": 0}]}})",
     "/simulation/emitters/0/height: expected the diameter of the disc, which is 1, found 2"},
    {"EmitterStopsFirst",
     R"({"simulation": {"emitters": [{"shape": "disc", "centre": [0,1,0], "direction": [0,1,0], "width": 1,
                                      "height": 1, "speed": 1, "rate": 0, "start": 2, "stop": 1}]}})",
     "/simulation/emitters/0/stop: expected 0, or a time after start, which is 2, found 1"},
    {"EmitterSquare", R"({"simulation": {"emitters": [{"shape": "square"}]}})",
     R"(/simulation/emitters/0/shape: expected one of "disc", "box", found "square")"},
    {"DrainOval", R"({"simulation": {"drains": [{"shape": "sphere", "centre": [0,0,0], "half": [1,2,1]}]}})",
     "/simulation/drains/0/half: expected the radius of the sphere, three times, found [1, 2, 1]"},
    {"FieldIncomplete", R"({"simulation": {"fields": [{"kind": "wind", "centre": [0,0,0], "axis": [1,0,0]}]}})",
     "/simulation/fields/0/strength: missing"},
    {"BodyFlat",
     R"({"simulation": {"bodies": [{"shape": "capsule", "centre": [0,1,0], "half": [0.2,0.1,0.2], "turn_degrees": 0,
                                    "density": 1, "velocity": [0,0,0], "spin": [0,0,0], "path": []}]}})",
     "/simulation/bodies/0/half: expected the radius of the capsule, its half length with the caps, its radius, found "
     "[0.2, 0.1, 0.2]"},
    {"BodyBackInTime",
     R"({"simulation": {"bodies": [{"shape": "box", "centre": [0,1,0], "half": [0.2,0.1,0.2], "turn_degrees": 0,
                                    "density": 1, "velocity": [0,0,0], "spin": [0,0,0],
                                    "path": [{"time": 1, "centre": [0,0,0], "turn_degrees": 0},
                                             {"time": 1, "centre": [0,0,0], "turn_degrees": 0}]}]}})",
     "/simulation/bodies/0/path/1/time: expected a time after 1, found 1"},
    {"BodyIncomplete", R"({"simulation": {"bodies": [{"shape": "sphere", "centre": [0,1,0]}]}})",
     "/simulation/bodies/0/half: missing"},
    {"CflTooLarge", R"({"simulation": {"cfl": 0.6}})", "/simulation/cfl: expected a number in [0.01, 0.5], found 0.6"},
    {"FramesBackwards", R"({"frames": [5, 2]})",
     "/frames/1: expected a whole number >= the first frame, which is 5, found 2"},
    {"FramesOne", R"({"frames": [5]})", "/frames: expected a list of 2 whole numbers, found [5]"},
    {"FramesFraction", R"({"frames": [1, 2.5]})", "/frames/1: expected a whole number in [0, 1000000000], found 2.5"},
    {"SizeZero", R"({"size": [0, 720]})", "/size/0: expected a whole number in [1, 16384], found 0"},
    {"SizeHuge", R"({"size": [1280, 99999]})", "/size/1: expected a whole number in [1, 16384], found 99999"},
    {"SizeText", R"({"size": "1280x720"})", R"(/size: expected a list of 2 whole numbers, found "1280x720")"},
};

INSTANTIATE_TEST_SUITE_P(Scenes, ABadScene, ::testing::ValuesIn(kBadScenes),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(BadJson, SaysLineAndColumn) {
    const Result<Scene> scene = parseScene("{\n  \"size\": [1,,2]\n}", "s.json");
    ASSERT_FALSE(scene.ok());
    EXPECT_NE(scene.error().detail.find("line 2, column 14"), std::string::npos) << scene.error().detail;
}

TEST(BadJson, IsAnErrorAndNotAFault) {
    for (const char* text : {"", "{", "\xff\xfe", R"({"size": 1e999})", "nul", R"({"a": "\ud800"})"}) {
        EXPECT_FALSE(parseScene(text, "s.json").ok()) << text;
    }
    EXPECT_FALSE(parseScene(std::string(100'000, '['), "s.json").ok());
}

}  // namespace
}  // namespace sluice::scene
