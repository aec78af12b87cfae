// SPDX-License-Identifier: MIT
// What the solver or the plugin refuses of a scene that could be read, told by its place in the scene.
#include "app/checked_setup.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "sluice/simulation_limits.hpp"

namespace sluice::cli {
namespace {

std::string tap(const char* centre, const char* more = "") {
    return fmt::format(R"({{"shape": "disc", "centre": {}, "direction": [0, -1, 0], "width": 0.2, "height": 0.2,
                           "speed": 1{}}})",
                       centre, more);
}

std::string faster(std::string tap) {
    constexpr std::string_view kSpeed = R"("speed": 1)";
    return tap.replace(tap.find(kSpeed), kSpeed.size(), R"("speed": 9000)");
}

std::string body(const char* centre) {
    return fmt::format(R"({{"shape": "sphere", "centre": {}, "half": [0.1, 0.1, 0.1], "turn_degrees": 0,
                           "density": 1, "velocity": [0, 0, 0], "spin": [0, 0, 0], "path": []}})",
                       centre);
}

std::string fluidOf(double density) {
    return fmt::format(R"({{"density": {}, "viscosity": 0, "tension": 0, "adhesion": 0, "colour": [0, 0, 1]}})",
                       density);
}

std::string list(const char* key, const std::string& member, std::size_t times = 1) {
    std::string all = member;
    for (std::size_t i = 1; i < times; ++i) {
        all += ", " + member;
    }
    return fmt::format(R"("{}": [{}])", key, all);
}

struct Refused {
    const char* name;
    std::string simulation;  ///< members of the scene's simulation
    std::string engine;      ///< and of its engine
    std::string thing, detail;
};

void PrintTo(const Refused& refused, std::ostream* out) {
    *out << refused.name;
}

Result<simulator::Setup> setupOf(const std::string& simulation, const std::string& engine,
                                 const std::vector<simulator::Mesh>& meshes = {}) {
    const Result<scene::Scene> scene =
        scene::parseScene(fmt::format(R"({{"simulation": {{{}}}, "engine": {{{}}}}})", simulation, engine), "s.json");
    EXPECT_TRUE(scene.ok()) << "the case is of what a scene alone does not tell: " << scene.error().message();
    return scene ? checkedSetup(scene.value(), meshes) : Result<simulator::Setup>(scene.error());
}

/// A cube of half a metre about the origin, as an OBJ file has it.
simulator::Mesh cube() {
    simulator::Mesh mesh{"cube.obj", {}, {}};
    for (unsigned i = 0; i < 8; ++i) {
        mesh.corners.push_back({(i & 1U) != 0 ? 0.5 : -0.5, (i & 2U) != 0 ? 0.5 : -0.5, (i & 4U) != 0 ? 0.5 : -0.5});
    }
    mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return mesh;
}

class ARefusedSetup : public ::testing::TestWithParam<Refused> {};

TEST_P(ARefusedSetup, IsToldByItsPlaceInTheScene) {
    const auto setup = setupOf(GetParam().simulation, GetParam().engine);
    ASSERT_FALSE(setup.ok());
    EXPECT_EQ(setup.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(setup.error().thing, GetParam().thing);
    EXPECT_NE(setup.error().detail.find(GetParam().detail), std::string::npos) << setup.error().detail;
    EXPECT_FALSE(setup.error().remedy.empty());
}

const std::vector<Refused>& refusals() {
    static const std::string inside = tap("[0, 1, 0]");
    static const std::vector<Refused> all{
        {"Rate", list("emitters", tap("[0, 1, 0]", R"(, "rate": 1000000)")), "", "/simulation/emitters/0/rate",
         "expected a rate in [0, 525] particles per second, which is 21 at a time, two radii apart, found 1000000"},
        {"OutsideTheDomain", list("emitters", inside + ", " + tap("[1, 1, 0]")), "", "/simulation/emitters/1",
         "lies outside the domain, [-1, 0, -1] to [1, 2, 1], or within half a radius of its walls (centre [1, 1, 0])"},
        {"InASphere", list("emitters", inside) + R"(, "spheres": [{"centre": [0, 1, 0], "radius": 0.5}])", "",
         "/simulation/emitters/0", "lies in /simulation/spheres/0 or within half a radius of it (centre [0, 1, 0])"},
        {"InAPillar", list("emitters", inside) + R"(, "capsules": [{"from": [5, 0, 0], "to": [5, 1, 0], "radius": 1}])",
         R"("pillars": [{"base": [9, 0, 0], "radius": 0.1, "height": 1}, {"base": [0, 0, 0], "radius": 0.5, "height": 2}])",
         "/simulation/emitters/0", "lies in /engine/pillars/1 or within"},
        {"InACrate",
         list("emitters", inside) + R"(, "boxes": [{"centre": [5, 0, 0], "half": [1, 1, 1], "turn_degrees": 0}])",
         R"("crates": [{"centre": [0, 1, 0], "size": 1, "turn_degrees": 0}])", "/simulation/emitters/0",
         "lies in /engine/crates/0 or within"},
        {"InTheLastWallOfABasin", list("emitters", inside),
         R"("crates": [{"centre": [5, 0, 0], "size": 1, "turn_degrees": 0}],
            "basins": [{"centre": [0, 0.5, 0], "half_x": 2, "half_z": 2, "height": 1, "wall": 0.5},
                       {"centre": [0, 0.5, -2], "half_x": 2, "half_z": 1.5, "height": 1, "wall": 1}])",
         "/simulation/emitters/0", "lies in /engine/basins/1 or within"},
        {"InAPlane", list("emitters", inside) + R"(, "planes": [{"normal": [1, 0, 0], "through": [0.5, 0, 0]}])", "",
         "/simulation/emitters/0", "lies in /simulation/planes/0 or within"},
        {"BelowTheFloor", list("emitters", inside), R"("floor_height": 1.5)", "/simulation/emitters/0",
         "lies in /engine/floor_height or within"},
        {"OpeningTooLarge",
         R"("emitters": [{"shape": "box", "centre": [0, 1, 0], "direction": [0, -1, 0], "width": 100, "height": 100, "speed": 1}])",
         "", "/simulation/emitters/0/width", "an opening for at most 16384 particles"},
        {"IterationsOfAKernel", R"("iterations": 1, "kernel": "wendland")", "", "/simulation/iterations",
         "expected 2 to 64 with a kernel other than poly6, found 1"},
        {"Densities", list("fluids", fluidOf(1) + ", " + fluidOf(0.01)), "", "/simulation/fluids",
         "expected a heaviest at most 16 times as dense as the lightest, found 1 and 0.01, 100 times"},
        {"DomainTooSmall", R"("domain": {"low": [0, 0, 0], "high": [0.05, 1, 1]})", "", "/simulation/domain",
         "(4 radii) or more each way, found [0, 0, 0] to [0.05, 1, 1]"},
        {"DomainTooFar", R"("radius": 0.0001, "domain": {"low": [0, 0, 0], "high": [11, 1, 1]})", "",
         "/simulation/domain", "(100,000 radii), found [0, 0, 0] to [11, 1, 1]"},
        {"BodyOutside", list("bodies", body("[0, 1, 0]") + ", " + body("[0, 3, 0]")), "", "/simulation/bodies/1/centre",
         "expected a centre in the domain, [-1, 0, -1] to [1, 2, 1], found [0, 3, 0]"},
        {"BodyInASolid", list("bodies", body("[0, 1, 0]")) + R"(, "spheres": [{"centre": [0, 0.8, 0], "radius": 0.3}])",
         "", "/simulation/bodies/0/centre", "[0, 1, 0] lies in /simulation/spheres/0"},
        {"BodyInABody", list("bodies", body("[0.5, 1, 0]") + ", " + body("[0, 1, 0]") + ", " + body("[0, 1, 0]")), "",
         "/simulation/bodies/1/centre", "[0, 1, 0] lies in /simulation/bodies/2"},
        {"BlockTooFast", R"("fluid": [{"low": [0, 0, 0], "high": [1, 1, 1], "velocity": [0, -5000, 0]}])", "",
         "/simulation/fluid/0/velocity", "the fastest that the shortest steps of a frame can follow, found 5000 m/s"},
        {"TapTooFast", list("emitters", inside + ", " + faster(tap("[0.5, 1, 0]"))), "", "/simulation/emitters/1/speed",
         "can follow, found 9000 m/s"},
        {"BodyTooFast", R"("bodies": [{"shape": "sphere", "centre": [0, 1, 0], "half": [0.1, 0.1, 0.1],
         "turn_degrees": 0, "density": 1, "velocity": [9000, 0, 0], "spin": [0, 0, 0], "path": []}])",
         "", "/simulation/bodies/0/velocity", "can follow, found 9000 m/s"},
        {"CrateThatIsNone", "", R"("crates": [{"centre": [0, 1, 0], "size": 1e-45, "turn_degrees": 0}])",
         "/engine/crates/0", "half extents > 0"},
        {"Emitters", list("emitters", inside, 17), "", "/simulation/emitters", "expected at most 16, found 17"},
        {"Drains", list("drains", R"({"shape": "box", "centre": [0, 0, 0], "half": [1, 1, 1]})", 17), "",
         "/simulation/drains", "expected at most 16, found 17"},
        {"Fields",
         list("fields", R"({"kind": "wind", "centre": [0, 0, 0], "axis": [1, 0, 0], "strength": 1, "radius": 0})", 17),
         "", "/simulation/fields", "expected at most 16, found 17"},
        {"Bodies", list("bodies", body("[0, 1, 0]"), 17), "", "/simulation/bodies", "expected at most 16, found 17"},
        {"Fluids", list("fluids", fluidOf(1), 9), "", "/simulation/fluids", "expected at most 8, found 9"},
        {"Solids", list("spheres", R"({"centre": [0, 1, 0], "radius": 0.1})", 65), "",
         "/simulation and /engine: solids", "expected at most 64 that reach into the domain, found 65"},
    };
    return all;
}

INSTANTIATE_TEST_SUITE_P(Scenes, ARefusedSetup, ::testing::ValuesIn(refusals()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(CheckedSetup, MeshesAreSolidsToWhatIsBesideThem) {
    EXPECT_TRUE(setupOf(list("emitters", tap("[0, 1, 0]")), "", {cube()}).ok());
    const auto tapped = setupOf(list("emitters", tap("[0, 0.3, 0]")), "", {cube()});
    ASSERT_FALSE(tapped.ok());
    EXPECT_EQ(tapped.error().thing, "/simulation/emitters/0");
    EXPECT_NE(tapped.error().detail.find("lies in the meshes or within half a radius"), std::string::npos);
    const auto pushed = setupOf(list("bodies", body("[0, 1, 0]")), "", {cube()});
    ASSERT_FALSE(pushed.ok());
    EXPECT_EQ(pushed.error().thing, "/simulation/bodies");
    simulator::Mesh open = cube();
    open.triangles.pop_back();
    const auto closed = setupOf("", "", {open});
    ASSERT_FALSE(closed.ok());
    EXPECT_EQ(closed.error().thing, "cube.obj");
}

TEST(CheckedSetup, ASceneHoldsNoMoreThanThePluginsInterfaceCarries) {
    scene::Scene scene;
    scene.simulation.bodies.resize(1);
    scene.simulation.bodies[0].half = {0.1F, 0.1F, 0.1F};
    scene.simulation.bodies[0].density = 1.0F;
    for (std::size_t i = 0; i <= kMostPathPoints; ++i) {
        scene.simulation.bodies[0].path.push_back({static_cast<float>(i), {0, 1, 0}, 0});
    }
    const auto paths = checkedSetup(scene, {});
    ASSERT_FALSE(paths.ok());
    EXPECT_EQ(paths.error().message(),
              "/simulation/bodies: expected at most 65536 points of paths, found 65537 (leave some out)");
    scene = {};
    scene.simulation.spheres.assign(kMostSolids, {{9, 9, 9}, 1});
    const auto solids = checkedSetup(scene, {});
    ASSERT_FALSE(solids.ok());
    EXPECT_EQ(solids.error().detail, "expected at most 65536 in and out of the domain, found 65537") << "and the floor";
    const auto meshes = checkedSetup({}, std::vector<simulator::Mesh>(kMostMeshes + 1));
    ASSERT_FALSE(meshes.ok());
    EXPECT_EQ(meshes.error().detail, "expected at most 1024 meshes, found 1025");
}

}  // namespace
}  // namespace sluice::cli
