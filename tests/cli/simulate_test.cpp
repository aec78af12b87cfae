// SPDX-License-Identifier: MIT
// `sluice simulate`: the files it writes, that they are the same again, and what it says when it cannot.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Simulate : public ProgramTest {
  protected:
    /// A few hundred large particles that fall beside a pillar and onto a crate of the engine.
    void writeFluid(const std::string& name, const std::string& velocity = "[0, 0, 0]") const {
        write(name, R"({
            "engine": {"pillars": [{"base": [0.5, 0, 0], "radius": 0.2, "height": 1}],
                       "crates": [{"centre": [-0.5, 0.2, 0], "size": 0.4, "turn_degrees": 30}]},
            "simulation": {"radius": 0.05, "fluid": [{"low": [-0.6, 0.5, -0.4], "high": [0.2, 1.1, 0.4],
                                                      "velocity": )" +
                        velocity + R"(}]}})");
    }
    nlohmann::json simulate(const std::string& words) const {
        const Outcome outcome = run("simulate " + words + " --json");
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return nlohmann::json::parse(outcome.out, nullptr, false);
    }
};

TEST_F(Simulate, RangesOfOneRunByTwoProcessesAreTheSameFiles) {
    writeFluid("s.json");
    const nlohmann::json whole = simulate("s.json -o whole_##.ply --frames 1..4 --validation");
    EXPECT_EQ(whole["frames"]["written"], 4);
    EXPECT_EQ(whole["particles"]["count"], 8 * 6 * 8);
    EXPECT_EQ(whole["validation_messages"], 0);
    EXPECT_GE(whole["steps"], 12);
    const nlohmann::json part = simulate("s.json -o part_##.ply --frames 3..4");
    EXPECT_EQ(part["frames"]["written"], 2);
    EXPECT_EQ(part["replay_hash"], whole["replay_hash"]);
    EXPECT_THAT(files(), ElementsAre("part_03.ply", "part_04.ply", "s.json", "whole_01.ply", "whole_02.ply",
                                     "whole_03.ply", "whole_04.ply"));
    EXPECT_EQ(read("part_03.ply"), read("whole_03.ply"));
    EXPECT_EQ(read("part_04.ply"), read("whole_04.ply"));
    EXPECT_NE(read("whole_03.ply"), read("whole_04.ply"));
    EXPECT_NE(simulate("s.json -o other_##.pos --frames 4..4 --seed 2")["replay_hash"], whole["replay_hash"]);
}

TEST_F(Simulate, TwoFluidsAreWrittenInTheirColoursAndTooUnlikeOnesAreRefused) {
    const auto scene = [](const std::string& density) {
        return R"({"simulation": {"radius": 0.05, "collide_with_engine": false,
                   "fluids": [{"density": 1, "viscosity": 0.02, "tension": 0, "adhesion": 0, "colour": [0, 0, 1]},
                              {"density": )" +
               density + R"(, "viscosity": 0.1, "tension": 0, "adhesion": 0, "colour": [1, 0.5, 0]}],
                   "fluid": [{"low": [-0.4, 0, -0.4], "high": [0.4, 0.4, 0.4], "velocity": [0, 0, 0], "fluid": 1},
                             {"low": [-0.4, 0.4, -0.4], "high": [0.4, 0.8, 0.4], "velocity": [0, 0, 0]}]}})";
    };
    write("two.json", scene("0.25"));
    const nlohmann::json two = simulate("two.json -o two_##.ply --frames 1..3 --validation");
    EXPECT_EQ(two["validation_messages"], 0);
    EXPECT_EQ(two["particles"]["count"], 512);
    EXPECT_THAT(read("two_03.ply"), HasSubstr("property"));
    EXPECT_THAT(read("two_03.ply"), HasSubstr("red"));
    write("alike.json", scene("1"));
    EXPECT_NE(simulate("alike.json -o alike_##.pos --frames 1..3")["replay_hash"], two["replay_hash"]);
    write("wide.json", scene("0.01"));
    const Outcome wide = run("simulate wide.json -o wide.pos");
    EXPECT_EQ(wide.code, 2);
    EXPECT_THAT(wide.err, HasSubstr("1 and 0.01, 100 times"));
}

TEST_F(Simulate, AMeshKeepsTheFluidOutAndAnOpenOneIsRefused) {
    const auto scene = [](const std::string& solid) {
        return R"({"simulation": {"radius": 0.05, "collide_with_engine": false,
                   "fluid": [{"low": [-0.4, 0.2, -0.4], "high": [0.4, 1, 0.4], "velocity": [0, 0, 0]}], )" +
               solid + "}}";
    };
    const std::string corners = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n";
    const std::string faces = "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\n";
    std::filesystem::create_directory(at("models"));
    write("models/cube.obj", corners + faces + "f 5 6 8 7\n");
    write("mesh.json", scene(R"("meshes": [{"path": "models/cube.obj", "position": [0, 0.4, 0], "turn_degrees": 30,
                                           "scale": 0.2}])"));
    write("box.json", scene(R"("boxes": [{"centre": [0, 0.4, 0], "half": [0.2, 0.2, 0.2], "turn_degrees": 30}])"));
    const nlohmann::json mesh = simulate("mesh.json -o mesh_##.ply --frames 1..3 --validation");
    const nlohmann::json box = simulate("box.json -o box_##.ply --frames 1..3");
    EXPECT_EQ(mesh["validation_messages"], 0);
    // Of 8 x 8 x 8 particles the cube has taken its own volume, as the box has but for its edges.
    EXPECT_LT(box["particles"]["count"], 470);
    EXPECT_NEAR(mesh["particles"]["count"].get<double>(), box["particles"]["count"].get<double>(), 16.0);
    EXPECT_NE(mesh["replay_hash"], box["replay_hash"]);
    write("models/cube.obj", corners + faces);
    const Outcome open = run("simulate mesh.json -o open.ply");
    EXPECT_EQ(open.code, 2);
    EXPECT_THAT(open.err, AllOf(HasSubstr("models/cube.obj: expected a closed surface"), HasSubstr("Fill Holes")));
    write("none.json",
          scene(R"("meshes": [{"path": "none.obj", "position": [0, 0, 0], "turn_degrees": 0, "scale": 1}])"));
    EXPECT_THAT(run("simulate none.json -o none.ply").err, HasSubstr("none.obj: No such file"));
}

class SimulateSeen : public Simulate {
  protected:
    /// Water that falls on a floor and a crate, which are seen from above.
    void scene(const std::string& name, const std::string& simulation, const std::string& size = "[96, 72]",
               const std::string& camera = R"("position": [0, 2.6, 1.6])") const {
        write(name, R"({"size": )" + size + R"(, "camera": {"target": [0, 0.4, 0], )" + camera + R"(},
            "engine": {"floor_height": 0.3, "crates": [{"centre": [-0.3, 0.5, 0], "size": 0.4, "turn_degrees": 30}]},
            "simulation": {"radius": 0.05, )" +
                        simulation + R"(, "fluid": [{"low": [-0.4, 0.8, -0.4], "high": [0.4, 1.2, 0.4],
                                                     "velocity": [0, -4, 0]}]}})");
    }
    std::string refused(const std::string& words, int code = 2) const {
        const Outcome outcome = run("simulate " + words + " -o f.ply --frames 1..1");
        EXPECT_EQ(outcome.code, code) << words;
        EXPECT_FALSE(std::filesystem::exists(at("f.ply")));
        return outcome.err;
    }
    /// Share of the particles that are in the floor.
    double sunk(const char* name) const {
        const auto set = particles::load(at(name));
        EXPECT_TRUE(set.ok()) << name;
        double found = 0.0;
        for (std::size_t i = 1; set && i < set.value().position.size(); i += 3) {
            found += set.value().position[i] < 0.32F ? 1.0 : 0.0;
        }
        return set ? found / static_cast<double>(set.value().count()) : 0.0;
    }
    static constexpr const char* kSeen = R"("collide": "depth", "depth": {"path": "bare.exr"})";
};

TEST_F(SimulateSeen, WhatAPictureShowsHoldsTheFluidTheSameBitsEachTime) {
    scene("s.json", kSeen);
    ASSERT_EQ(run("render s.json --no-fluid --frames 1..1 -o bare.png --layers bare.exr").code, 0);
    const nlohmann::json seen = simulate("s.json -o seen_##.ply --frames 1..6 --validation");
    EXPECT_EQ(seen["validation_messages"], 0);
    EXPECT_EQ(simulate("s.json -o again_##.ply --frames 6..6")["replay_hash"], seen["replay_hash"]);
    scene("solids.json", R"("collide": "solids")");
    (void)simulate("solids.json -o solids_##.ply --frames 6..6");
    scene("through.json", R"("collide_with_engine": false)");
    (void)simulate("through.json -o through_##.ply --frames 6..6");
    EXPECT_EQ(sunk("solids_06.ply"), 0.0);
    EXPECT_LT(sunk("seen_06.ply"), 0.1) << "but behind the crate, where the camera sees no floor";
    EXPECT_GT(sunk("through_06.ply"), 0.5);
    // A file for each frame: the same picture three times is the same fluid.
    for (const char* copy : {"bare_1.exr", "bare_2.exr", "bare_3.exr"}) {
        std::filesystem::copy_file(at("bare.exr"), at(copy));
    }
    scene("moving.json", R"("collide": "depth", "depth": {"path": "bare_#.exr"})");
    (void)simulate("moving.json -o moving_##.ply --frames 4..4");
    EXPECT_EQ(read("moving_04.ply"), read("seen_04.ply"));
    EXPECT_THAT(run("simulate moving.json -o bare_#.exr --frames 2..2").err, HasSubstr("bare_2.exr"));
    std::filesystem::remove(at("bare_2.exr"));
    EXPECT_THAT(run("simulate moving.json -o f.ply --frames 4..4").err, HasSubstr("bare_2.exr: No such file"));
}

TEST_F(SimulateSeen, APictureThatIsNotOfTheScenesCameraIsRefusedByName) {
    scene("s.json", kSeen);
    EXPECT_THAT(refused("s.json"), HasSubstr("bare.exr: No such file"));
    ASSERT_EQ(run("render s.json --no-fluid --frames 1..1 -o bare.png --layers bare.exr").code, 0);
    scene("picture.json", R"("collide": "depth", "depth": {"path": "bare.png"})");
    EXPECT_THAT(refused("picture.json"), HasSubstr("bare.png: has no channel host.Z, nor Z"));
    scene("none.json", R"("collide": "depth")");
    EXPECT_THAT(refused("none.json"), HasSubstr("none.json: /simulation/depth/path: expected a file"));
    scene("wide.json", kSeen, "[96, 54]");
    EXPECT_THAT(refused("wide.json"), HasSubstr("expected pictures of the scene's shape, 96x54, found 96x72"));
    scene("aside.json", kSeen, "[96, 72]", R"("position": [0.01, 2.6, 1.6])");
    EXPECT_THAT(refused("aside.json"), HasSubstr("expected the scene's camera of frame 1, found one that stands"));
    scene("zoom.json", kSeen, "[192, 144]", R"("position": [0, 2.6, 1.6], "vertical_fov_degrees": 58)");
    EXPECT_THAT(refused("zoom.json"), HasSubstr("found another lens"));
    scene("thin.json", R"("collide": "depth", "depth": {"path": "bare.exr", "thickness": 0.04})");
    EXPECT_THAT(refused("thin.json"), HasSubstr("/simulation/depth/thickness: expected 0, or a number >= 0.05"));
    scene("bodies.json", std::string(kSeen) + R"(, "bodies": [{"shape": "sphere", "centre": [0, 1.5, 0],
        "half": [0.1, 0.1, 0.1], "turn_degrees": 0, "density": 1, "velocity": [0, 0, 0], "spin": [0, 0, 0],
        "path": []}])");
    EXPECT_THAT(refused("bodies.json"), HasSubstr("bodies do not meet what is seen"));
}

TEST_F(Simulate, SaysWhatItDidAndWhereTheTimeWent) {
    writeFluid("s.json");
    const Outcome outcome = run("simulate s.json -o f_##.pos --frames 1..2");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("384 particles of radius 0.05000 m on "), HasSubstr("neighbours"),
                                   HasSubstr("ms per step"), HasSubstr("2 files, frames 1 to 2; replay hash ")));
    EXPECT_EQ(run("simulate s.json -o f_##.pos --frames 1..2 --quiet").out, "");
}

TEST_F(Simulate, ATapFillsAnEmptySceneAndADrainTakesFromIt) {
    write("s.json", R"({"simulation": {"radius": 0.05,
        "emitters": [{"shape": "disc", "centre": [0, 1, 0], "direction": [0, -1, 0], "width": 0.4, "height": 0.4,
                      "speed": 2, "rate": 0, "start": 0, "stop": 0}],
        "drains": [{"shape": "box", "centre": [0, 0, 0], "half": [1, 0.2, 1]}],
        "fields": [{"kind": "wind", "centre": [0, 1, 0], "axis": [1, 0, 0], "strength": 2, "radius": 1}]}})");
    const nlohmann::json done = simulate("s.json -o f_##.ply --frames 1..16 --validation");
    EXPECT_EQ(done["particles"]["count"], 0);
    EXPECT_GT(done["particles"]["drained"], 0);
    EXPECT_EQ(done["particles"]["at_end"].get<int>(),
              done["particles"]["born"].get<int>() - done["particles"]["drained"].get<int>());
    EXPECT_EQ(simulate("s.json -o g_##.ply --frames 16..16")["replay_hash"], done["replay_hash"]);
    EXPECT_EQ(read("f_16.ply"), read("g_16.ply"));
}

TEST_F(Simulate, WhatTheSolverRefusesIsTheSameWordsFromBothCommandsBeforeAnyFile) {
    const auto tap = [this](const char* name, const char* centre, const char* rate) {
        write(name, fmt::format(R"({{"size": [48, 27], "simulation": {{"radius": 0.05, "emitters": [
            {{"shape": "disc", "centre": {}, "direction": [0, -1, 0], "width": 0.4, "height": 0.4, "speed": 2,
              "rate": {}}}]}}}})",
                                centre, rate));
    };
    tap("wall.json", "[1, 1, 0]", "0");
    tap("rate.json", "[0, 1, 0]", "1000000");
    write("kernel.json", R"({"size": [48, 27], "simulation": {"radius": 0.05, "iterations": 1, "kernel": "spline",
        "fluid": [{"low": [-0.4, 0, -0.4], "high": [0.4, 0.3, 0.4], "velocity": [0, 0, 0]}]}})");
    const auto refused = [this](const std::string& scene, const char* says) {
        const Outcome simulated = run("simulate " + scene + " -o made/f.pos");
        const Outcome rendered = run("render " + scene + " -o made/f.png --frames 1..3");
        EXPECT_EQ(simulated.code, 2);
        EXPECT_EQ(rendered.code, 2);
        EXPECT_THAT(simulated.err, HasSubstr(scene + ": /simulation/" + says));
        EXPECT_EQ(simulated.err, rendered.err);
        EXPECT_EQ(std::count(rendered.err.begin(), rendered.err.end(), '\n'), 1) << rendered.err;
        EXPECT_FALSE(exists("made"));
    };
    refused("wall.json", "emitters/0: a point of its opening, [");
    refused("rate.json", "emitters/0/rate: expected a rate in [0, 240]");
    refused("kernel.json", "iterations: expected 2 to 64 with a kernel other than poly6, found 1");
}

TEST_F(Simulate, BodiesAreWrittenBesideTheirFrameAndDrawnWhereTheyAre) {
    const auto scene = [this](const char* name, const char* half) {
        write(name, std::string(R"({"size": [96, 64], "particles": {"path": "f_##.pos"},
            "camera": {"position": [0, 1.5, -3], "target": [0, 0.6, 0]},
            "simulation": {"radius": 0.05, "fluid": [{"low": [-0.4, 0, -0.4], "high": [0.4, 0.3, 0.4],
                                                      "velocity": [0, 0, 0]}],
            "bodies": [{"shape": "box", "centre": [0, 0.8, 0], "half": )") +
                        half + R"(, "turn_degrees": 20,
                        "density": 0.5, "velocity": [0, 0, 0], "spin": [0, 0, 0], "path": []}]}})");
    };
    scene("s.json", "[0.2, 0.2, 0.2]");
    ASSERT_EQ(simulate("s.json -o f_##.pos --frames 1..6")["frames"]["written"], 6);
    const auto height = [this](const char* file) {
        return nlohmann::json::parse(read(file))["bodies"][0]["centre"][1].get<double>();
    };
    EXPECT_NEAR(height("f_01.bodies.json"), 0.8, 1e-6);
    EXPECT_NEAR(height("f_06.bodies.json"), 0.8 - 0.5 * 9.81 / 36.0, 0.02) << "it falls";
    const Outcome drawn = run("render s.json --frames 1..6 --no-fluid -o p_##.png");
    ASSERT_EQ(drawn.code, 0) << drawn.err;
    EXPECT_NE(read("p_01.png"), read("p_06.png")) << "nothing but the body moves";
    std::filesystem::remove(at("f_03.bodies.json"));
    const Outcome missing = run("render s.json --frames 1..6 --no-fluid -o q_##.png");
    EXPECT_EQ(missing.code, 2);
    EXPECT_THAT(missing.err, HasSubstr("f_03.bodies.json: cannot be opened, and the scene has bodies"));
    write("f_03.bodies.json", R"({"bodies": [{"shape": "cone"}]})");
    EXPECT_THAT(run("render s.json --frames 3..3 --no-fluid -o q.png").err, HasSubstr("the shape \"cone\""));
}

TEST_F(Simulate, AWrongCommandLineIsOneAndAWrongSceneTwo) {
    writeFluid("s.json");
    write("empty.json", "{}");
    write("small.json", R"({"simulation": {"fluid": [{"low": [0,0,0], "high": [0.01,1,1], "velocity": [0,0,0]}]}})");
    write("huge.json", R"({"simulation": {"radius": 0.0001,
                           "fluid": [{"low": [-1,0,-1], "high": [1,2,1], "velocity": [0,0,0]}]}})");
    const auto answer = [this](const char* words, int code, const char* says) {
        const Outcome outcome = run(std::string("simulate ") + words);
        EXPECT_EQ(outcome.code, code) << words << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(says)) << words;
    };
    answer("s.json -o f.pos --frames 1..3", 1, "\"f.pos\" has no place for the number of 3 frames");
    answer("s.json -o f_##.pos --frames 0..3", 1, "frame 1 is the start");
    answer("s.json -o f.png --frames 1..1", 1, "expected the ending .pos");
    answer("empty.json -o f.pos", 2, "empty.json: /simulation/fluid: ");
    answer("small.json -o f.pos", 2, "or an emitter, found none");
    answer("huge.json -o f.pos", 2, "at most 4000000 particles");
    EXPECT_THAT(files(), ElementsAre("empty.json", "huge.json", "s.json", "small.json"));
}

TEST_F(Simulate, AFluidThatIsTooFastIsReportedAndTheFramesBeforeStay) {
    // No block of a scene may be so fast, but the particles of a start are what they are.
    particles::ParticleSet set;
    set.radius = 0.05F;
    set.position = {0.0F, 1.0F, 0.0F, 0.2F, 1.0F, 0.0F};
    set.velocity = {0.0F, -1e5F, 0.0F, 0.0F, 0.0F, 0.0F};
    ASSERT_TRUE(particles::save(at("start.ply"), set).ok());
    write("s.json", R"({"simulation": {"radius": 0.05, "start": "start.ply"}})");
    const Outcome outcome = run("simulate s.json -o f_##.pos --frames 1..3");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("no step was stable"),
                                   HasSubstr("1e+05 m/s, that of a particle (give a smaller speed")));
    EXPECT_THAT(files(), ElementsAre("f_01.pos", "s.json", "start.ply"));
}

TEST_F(Simulate, ASignalEndsItWithinAFrameWhichIsNotWritten) {
    // At this gravity a frame is thousands of steps.
    write("s.json", R"({"simulation": {"gravity": [0, -10000, 0], "radius": 0.02, "frames_per_second": 5,
        "fluid": [{"low": [-0.6, 0, -0.6], "high": [0.6, 1.2, 0.6]}]}})");
    write("signalled", R"("$@" & while ! test -e f_01.pos; do sleep 0.05; done; sleep 0.3; kill -TERM $!; wait $!)");
    const Outcome outcome = run("simulate s.json -o f_##.pos --frames 1..2", "sh ./signalled");
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("interrupted in frame 2 of 1 to 2, which is not written; files written: 1"));
    EXPECT_THAT(files(), ElementsAre("f_01.pos", "s.json", "signalled"));
}

}  // namespace
}  // namespace sluice::test
