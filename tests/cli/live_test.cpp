// SPDX-License-Identifier: MIT
// `sluice render` of a scene that is simulated: the pictures are those of the files that `sluice simulate` writes.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "program.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Live : public ProgramTest {
  protected:
    /// A few hundred large particles that fall beside a pillar and onto a crate of the engine.
    void writeFluid(const std::string& name, const std::string& velocity = "[0, 0, 0]") const {
        write(name, R"({
            "size": [48, 27], "frames": [1, 4], "camera": {"position": [0, 1.5, 3], "target": [0, 0.5, 0]},
            "engine": {"pillars": [{"base": [0.5, 0, 0], "radius": 0.2, "height": 1}],
                       "crates": [{"centre": [-0.5, 0.2, 0], "size": 0.4, "turn_degrees": 30}]},
            "simulation": {"radius": 0.05, "fluid": [{"low": [-0.6, 0.5, -0.4], "high": [0.2, 1.1, 0.4],
                                                      "velocity": )" +
                        velocity + R"(}]}})");
    }
    nlohmann::json render(const std::string& words, int code = 0) const {
        const Outcome outcome = run("render " + words + " --json");
        EXPECT_EQ(outcome.code, code) << words << ": " << outcome.err;
        return nlohmann::json::parse(outcome.out, nullptr, false);
    }
};

TEST_F(Live, PicturesAreThoseOfTheSimulatedFilesForEveryNumberOfFramesInFlightAndInAProcessOfItsOwn) {
    writeFluid("s.json");
    ASSERT_EQ(run("simulate s.json -o f_##.pos").code, 0);
    ASSERT_EQ(run("render s.json --particles f_##.pos -o file_##.png").code, 0);
    const auto same = [this](const std::string& name) {
        for (const char* number : {"03.png", "04.png"}) {
            EXPECT_TRUE(read(name + number) == read(std::string("file_") + number)) << name << number;
        }
    };
    const nlohmann::json whole = render("s.json -o live_##.png --validation --ledger --trace t.json");
    same("live_");
    EXPECT_TRUE(read("live_01.png") == read("file_01.png"));
    EXPECT_FALSE(read("live_01.png") == read("live_04.png")) << "it falls";
    EXPECT_EQ(whole["simulation"]["frames"], 4);
    EXPECT_EQ(whole["particles"]["count"], 8 * 6 * 8);
    EXPECT_EQ(whole["bytes"]["uploaded"], 0);
    EXPECT_EQ(whole["validation_messages"], 0);
    EXPECT_TRUE(whole["ledger"]["findings"].empty()) << whole["ledger"].dump(1);
    EXPECT_THAT(read("t.json"), AllOf(HasSubstr("\"simulation\""), HasSubstr("simulation to renderer 4")));
    // The last frames alone: what was before them is simulated all the same.
    EXPECT_EQ(render("s.json -o two_##.png --frames 3..4 --frames-in-flight 2")["simulation"]["latency_frames"], 1);
    same("two_");
    (void)render("s.json -o three_##.png --frames 3..4 --frames-in-flight 3 --isolate");
    same("three_");
}

/// A tap, a drain, wind, a ball that floats and a crate on a path.
constexpr const char* kTap = R"({
    "size": [48, 27], "frames": [1, 4], "camera": {"position": [0, 1.5, 3], "target": [0, 0.5, 0]},
    "simulation": {"radius": 0.05, "tension": 0.05, "adhesion": 0.02, "overshoot": 0.15, "kernel": "wendland",
        "fluid": [{"low": [-0.6, 0, -0.4], "high": [0.2, 0.5, 0.4], "velocity": [0, 0, 0]}],
        "emitters": [{"shape": "disc", "centre": [-0.3, 1.5, 0], "direction": [0, -1, 0], "width": 0.4, "height": 0.4,
                      "speed": 4, "rate": 0, "start": 0, "stop": 0}],
        "drains": [{"shape": "box", "centre": [0.8, 0.2, 0], "half": [0.5, 0.3, 0.5]}],
        "fields": [{"kind": "wind", "centre": [0, 0, 0], "axis": [1, 0, 0], "strength": 20, "radius": 0}],
        "bodies": [{"shape": "sphere", "centre": [-0.2, 0.8, 0], "half": [0.2, 0.2, 0.2], "turn_degrees": 0, "density": 0.5,
                    "velocity": [0, -3, 0], "spin": [0, 0, 5], "path": []},
                   {"shape": "box", "centre": [0, 0, 0], "half": [0.1, 0.1, 0.1], "turn_degrees": 0, "density": 1,
                    "velocity": [0, 0, 0], "spin": [0, 0, 0],
                    "path": [{"time": 0, "centre": [0.4, 0.1, 0], "turn_degrees": 30},
                             {"time": 0.1, "centre": [0.1, 0.1, 0], "turn_degrees": 60}]}]}})";

TEST_F(Live, WhatComesGoesAndMovesIsThatOfTheSimulatedFiles) {
    write("tap.json", kTap);
    ASSERT_EQ(run("simulate tap.json -o f_##.pos").code, 0);
    EXPECT_NE(read("f_01.pos").size(), read("f_04.pos").size()) << "somebody is born";
    const nlohmann::json files = render("tap.json --particles f_##.pos -o file_##.png");
    const nlohmann::json live = render("tap.json -o live_##.png --validation --ledger --frames-in-flight 2");
    EXPECT_EQ(live["validation_messages"], 0);
    EXPECT_TRUE(live["ledger"]["findings"].empty()) << live["ledger"].dump(1);
    EXPECT_EQ(live["particles"]["count"], files["particles"]["count"]);
    (void)render("tap.json -o alone_##.png --isolate");
    EXPECT_THAT(run("render tap.json -o lost_##.png --fault device-lost@2").err, HasSubstr("it begins again"));
    EXPECT_TRUE(read("lost_04.png") == read("file_02.png")) << "a new renderer gets all of it, in frame 3";
    for (const char* number : {"01.png", "02.png", "03.png", "04.png"}) {
        EXPECT_TRUE(read(std::string("live_") + number) == read(std::string("file_") + number)) << number;
        EXPECT_TRUE(read(std::string("alone_") + number) == read(std::string("file_") + number)) << number;
    }
}

TEST_F(Live, SeveralFluidsAreThoseOfTheSimulatedFilesAndTheSameInAProcessOfTheirOwn) {
    write("oil.json", R"({
        "size": [48, 27], "frames": [1, 3], "camera": {"position": [0, 1.5, 3], "target": [0, 0.5, 0]},
        "simulation": {"radius": 0.05,
            "fluids": [{"density": 1, "viscosity": 0.02, "tension": 0, "adhesion": 0, "colour": [0, 0, 1]},
                       {"density": 0.25, "viscosity": 0.2, "tension": 0.5, "adhesion": 0, "colour": [1, 1, 0],
                        "absorption": [0.2, 0.8, 9]}],
            "fluid": [{"low": [-0.6, 0, -0.4], "high": [0.2, 0.4, 0.4], "velocity": [0, 0, 0], "fluid": 1},
                      {"low": [-0.6, 0.4, -0.4], "high": [0.2, 0.8, 0.4], "velocity": [0, 0, 0], "fluid": 0}],
            "emitters": [{"shape": "disc", "centre": [0.6, 1.5, 0], "direction": [0, -1, 0], "width": 0.4, "height": 0.4,
                          "speed": 4, "rate": 0, "start": 0, "stop": 0, "fluid": 1}]}})");
    ASSERT_EQ(run("simulate oil.json -o f_##.ply").code, 0);
    ASSERT_EQ(run("simulate oil.json -o f_##.pos --frames 3..3").code, 0);
    (void)render("oil.json --particles f_##.ply -o file_##.png --frames 3..3");  // whose colours say which is which
    (void)render("oil.json --particles f_##.pos -o first_##.png --frames 3..3");
    EXPECT_FALSE(read("first_03.png") == read("file_03.png")) << "without colours all are the first fluid";
    EXPECT_EQ(render("oil.json -o live_##.png --validation")["validation_messages"], 0);
    (void)render("oil.json -o alone_##.png --isolate");
    EXPECT_THAT(run("render oil.json -o lost_##.png --fault device-lost@1").err, HasSubstr("it begins again"));
    EXPECT_THAT(run("explain oil.json").out, HasSubstr("the fluids absorb light, each its own"));
    EXPECT_TRUE(read("live_03.png") == read("file_03.png"));
    EXPECT_TRUE(read("alone_03.png") == read("file_03.png"));
    EXPECT_TRUE(read("lost_03.png") == read("live_02.png")) << "a new renderer gets all of them, in frame 2";
}

TEST_F(Live, EllipsoidsAreDrawnIfTheSceneAsksAndAreTheSameInAProcessOfTheirOwn) {
    writeFluid("s.json");
    nlohmann::json scene = nlohmann::json::parse(read("s.json"));
    scene["simulation"]["anisotropy"]["ratio"] = 4;
    write("shaped.json", scene.dump());
    scene["fluid"]["ellipsoids"] = false;
    write("round.json", scene.dump());
    (void)render("s.json -o spheres.png --frames 4..4");
    EXPECT_EQ(render("shaped.json -o one.png --frames 4..4 --validation")["validation_messages"], 0);
    (void)render("shaped.json -o two.png --frames 4..4 --isolate");
    (void)render("round.json -o round.png --frames 4..4");
    EXPECT_FALSE(read("one.png") == read("spheres.png"));
    EXPECT_TRUE(read("two.png") == read("one.png"));
    EXPECT_TRUE(read("round.png") == read("spheres.png"));
}

TEST_F(Live, AFileToBeginWithGivesThePicturesOfTheSimulatedFilesAndWhatIsWrongWithItIsNamed) {
    writeFluid("s.json");
    ASSERT_EQ(run("simulate s.json -o cold_##.ply --frames 3..3").code, 0);
    nlohmann::json scene = nlohmann::json::parse(read("s.json"));
    scene["frames"] = {1, 3};
    scene["simulation"]["start"] = "cold_03.ply";
    scene["simulation"]["fluid"] = {
        {{"low", {0.6, 1.4, -0.2}}, {"high", {0.8, 1.6, 0.2}}, {"velocity", {0, 0, 0}}}};  // more, above it
    write("warm.json", scene.dump());
    ASSERT_EQ(run("simulate warm.json -o f_##.ply").code, 0);
    EXPECT_GT(read("f_01.ply").size(), read("cold_03.ply").size());
    ASSERT_EQ(run("render warm.json --particles f_##.ply -o file_##.png").code, 0);
    EXPECT_EQ(render("warm.json -o live_##.png --validation")["particles"]["count"], 8 * 6 * 8 + 2 * 2 * 4);
    (void)render("warm.json -o alone_##.png --isolate");
    EXPECT_FALSE(read("file_01.png") == read("file_03.png"));
    for (const char* number : {"01.png", "02.png", "03.png"}) {
        EXPECT_TRUE(read(std::string("live_") + number) == read(std::string("file_") + number)) << number;
        EXPECT_TRUE(read(std::string("alone_") + number) == read(std::string("file_") + number)) << number;
    }
    // What the file cannot say is said, by both commands.
    ASSERT_EQ(run("convert cold_03.ply cold_03.pos").code, 0);
    nlohmann::json silent = scene;
    silent["simulation"]["start"] = "cold_03.pos";
    silent["simulation"]["bodies"] = nlohmann::json::parse(
        R"([{"shape": "sphere", "centre": [0.8, 1.1, 0], "half": [0.1, 0.1, 0.1], "turn_degrees": 0, "density": 1,
             "velocity": [0, 0, 0], "spin": [0, 0, 0], "path": []}])");
    silent["simulation"]["fluids"] = nlohmann::json::parse(
        R"([{"density": 1, "viscosity": 0, "tension": 0, "adhesion": 0, "colour": [0, 0, 1]},
            {"density": 1, "viscosity": 0, "tension": 0, "adhesion": 0, "colour": [1, 0, 0]}])");
    write("silent.json", silent.dump());
    const Outcome said = run("simulate silent.json -o silent.ply --frames 1..1");
    EXPECT_EQ(said.code, 0);
    EXPECT_THAT(said.err, AllOf(HasSubstr("cold_03.pos: has no colours, so that all of its particles are of the first"),
                                HasSubstr("cold_03.pos: holds particles alone, so that /simulation/bodies begin")));
    EXPECT_EQ(run("render silent.json -o silent.png --frames 1..1").err, said.err);
    // By both commands, before anything is written.
    const auto refused = [&] {
        write("wrong.json", scene.dump());
        const Outcome outcome = run("simulate wrong.json -o no.ply --frames 1..1");
        EXPECT_EQ(outcome.code, 2);
        EXPECT_EQ(run("render wrong.json -o no.png --frames 1..1").code, 2);
        return outcome.err;
    };
    scene["simulation"]["fluid"][0]["low"] = {-1, 0, -1};
    EXPECT_THAT(refused(), HasSubstr("expected a position outside /simulation/fluid/0"));
    scene["simulation"]["fluid"] = nlohmann::json::array();
    scene["simulation"]["radius"] = 0.04;
    EXPECT_THAT(refused(), HasSubstr("cold_03.ply: expected particles of the radius of the simulation, 0.04 m"));
    scene["simulation"]["radius"] = 0.05;
    scene["simulation"]["spheres"] = {{{"centre", {-0.2, 0.6, 0}}, {"radius", 0.2}}};
    EXPECT_THAT(refused(), HasSubstr("expected a position in the domain, outside solids and bodies"));
    std::string cut = read("cold_03.ply");
    cut.resize(cut.size() - 5);
    write("cut.ply", cut);
    scene["simulation"]["start"] = "cut.ply";
    EXPECT_THAT(refused(), HasSubstr("cut.ply"));
    scene["simulation"]["start"] = "none.pos";
    EXPECT_THAT(refused(), HasSubstr("none.pos: cannot be read"));
    scene["simulation"]["start"] = "cold_03.ply";
    write("wrong.json", scene.dump());
    const Outcome over = run("simulate wrong.json -o cold_##.ply --frames 3..3");
    EXPECT_EQ(over.code, 1);
    EXPECT_THAT(over.err, HasSubstr("would be the file of the start and the output file (-o) at once"));
}

TEST_F(Live, AMeshIsASolidAndIsDrawn) {
    writeFluid("s.json");
    nlohmann::json scene = nlohmann::json::parse(read("s.json"));
    scene["frames"] = {1, 3};
    scene["simulation"]["meshes"] = {
        {{"path", "cube.obj"}, {"position", {0, 0.3, 0.5}}, {"turn_degrees", 30}, {"scale", 0.2}}};
    write("mesh.json", scene.dump());
    write("cube.obj",
          "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
          "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n");
    ASSERT_EQ(run("simulate mesh.json -o f_##.pos --frames 3..3").code, 0);
    ASSERT_EQ(run("render mesh.json --particles f_##.pos -o file_##.png --frames 3..3").code, 0);
    (void)render("mesh.json -o live_##.png --frames 3..3");
    EXPECT_TRUE(read("live_03.png") == read("file_03.png"));
    (void)render("mesh.json -o host.png --frames 3..3 --no-fluid");
    (void)render("s.json -o bare.png --frames 3..3 --no-fluid");
    EXPECT_FALSE(read("host.png") == read("bare.png"));
    scene["simulation"]["meshes"][0]["path"] = "m_03.ply";
    write("guard.json", scene.dump());
    write("m_03.ply", read("cube.obj"));
    const Outcome over = run("simulate guard.json -o m_##.ply");
    EXPECT_EQ(over.code, 1);
    EXPECT_THAT(over.err, HasSubstr("m_03.ply: would be the mesh file and the output file (-o) at once"));
    EXPECT_EQ(read("m_03.ply"), read("cube.obj"));
}

TEST_F(Live, AFluidThatCollidesWithItsPicturesDepthIsTheSameHoweverManyFramesAreInFlight) {
    write("seen.json", R"({
        "size": [64, 48], "frames": [1, 5], "camera": {"position": [0, 2.6, 1.6], "target": [0, 0.4, 0]},
        "engine": {"floor_height": 0.3, "crates": [{"centre": [-0.3, 0.5, 0], "size": 0.4, "turn_degrees": 30}]},
        "simulation": {"radius": 0.05, "collide": "depth",
                       "fluid": [{"low": [-0.4, 0.8, -0.4], "high": [0.4, 1.2, 0.4], "velocity": [0, -2, 0]}]}})");
    const nlohmann::json one = render("seen.json -o one_##.png --validation --ledger-log l.log --trace t.json");
    EXPECT_EQ(one["validation_messages"], 0);
    EXPECT_TRUE(one["ledger"]["findings"].empty()) << one["ledger"].dump(1);
    EXPECT_THAT(read("l.log"), AllOf(HasSubstr("captured depth 0"), HasSubstr("captured depth 1")));
    EXPECT_EQ(one["simulation"]["stands_still_from"], 0);
    EXPECT_EQ(one["bytes"]["uploaded"], 0);
    EXPECT_THAT(read("t.json"),
                AllOf(HasSubstr("capture_depth"), HasSubstr("CAPTURED_DEPTH"), HasSubstr("depth captured")));
    (void)render("seen.json -o three_##.png --frames-in-flight 3 --isolate");
    for (const char* number : {"02.png", "05.png"}) {
        EXPECT_TRUE(read(std::string("one_") + number) == read(std::string("three_") + number)) << number;
    }
    // The shapes themselves are not given to it: where the camera looks away it falls through the floor.
    nlohmann::json scene = nlohmann::json::parse(read("seen.json"));
    scene["simulation"]["collide"] = "solids";
    write("solids.json", scene.dump());
    (void)render("solids.json -o solids_##.png");
    EXPECT_TRUE(read("solids_01.png") == read("one_01.png"));
    EXPECT_FALSE(read("solids_05.png") == read("one_05.png"));
    EXPECT_THAT(run("render seen.json -o late_##.png --frames 2..3").err, HasSubstr("expected frames from 1, found 2"));
}

TEST_F(Live, TheLedgerFindsAFrameThatDoesNotWaitForItsFluid) {
    writeFluid("s.json");
    const nlohmann::json faulty = render("s.json -o f_##.png --fault skip-wait/simulation@3 --ledger");
    const std::string findings = faulty["ledger"]["findings"].dump();
    EXPECT_THAT(findings, AllOf(HasSubstr("output slot"), HasSubstr("simulation"))) << findings;
    EXPECT_EQ(run("render s.json -o f_##.png --fault drop/simulation@3").code, 1);
}

TEST_F(Live, AFluidThatIsTooFastStandsStillAndALostRendererBeginsAgain) {
    particles::ParticleSet set;  // a block of the scene would be refused
    set.radius = 0.05F;
    set.position = {0.0F, 1.0F, 0.0F, 0.2F, 1.0F, 0.0F};
    set.velocity = {0.0F, -1e5F, 0.0F, 0.0F, 0.0F, 0.0F};
    ASSERT_TRUE(particles::save(at("start.ply"), set).ok());
    write("fast.json", R"({"size": [48, 27], "frames": [1, 4], "simulation": {"radius": 0.05, "start": "start.ply"}})");
    const nlohmann::json fast = render("fast.json -o f_##.png", 3);
    EXPECT_EQ(fast["frames"]["with_fluid"], 4);
    EXPECT_EQ(fast["simulation"]["stands_still_from"], 2);
    EXPECT_THAT(fast["problems"].dump(), HasSubstr("stands still from frame 2 on"));
    EXPECT_TRUE(read("f_02.png") == read("f_04.png"));

    writeFluid("s.json");
    const Outcome lost = run("render s.json -o l_##.png --fault device-lost@2");
    EXPECT_EQ(lost.code, 3);
    EXPECT_THAT(lost.err, HasSubstr("from value 3 on it begins again"));
    EXPECT_THAT(lost.out, HasSubstr("simulated 4 frames")) << "numbered as the caller has them";
    (void)run("render s.json -o one_##.png --frames 1..1");
    EXPECT_TRUE(read("l_03.png") == read("one_01.png"));
}

TEST_F(Live, AWrongSceneOrOptionIsSaidBeforeAnythingIsWritten) {
    writeFluid("s.json");
    const Outcome none = run("render s.json -o f_##.png --frames 0..1");
    EXPECT_EQ(none.code, 2);
    EXPECT_THAT(none.err, HasSubstr("frame 1 is the start"));
    EXPECT_EQ(run("render s.json -o f_##.png --frames-in-flight 4").code, 1);
    write("open.json", R"({"simulation": {"fluid": [{"low": [-0.6, 0.5, -0.4], "high": [0.2, 1.1, 0.4],
                                                     "velocity": [0, 0, 0]}],
                                          "meshes": [{"path": "m.png", "position": [0, 0, 0], "turn_degrees": 0,
                                                      "scale": 1}]}})");
    write("m.png", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Outcome open = run("render open.json -o f.png");
    EXPECT_EQ(open.code, 2);
    EXPECT_THAT(open.err, HasSubstr("m.png: expected a closed surface"));
    EXPECT_THAT(run("render open.json --particles p.pos -o m.png").err, HasSubstr("would be the mesh file and"));
    EXPECT_EQ(read("m.png").substr(0, 7), "v 0 0 0");
    EXPECT_THAT(run("explain s.json").out, HasSubstr("384 particles"));
}

}  // namespace
}  // namespace sluice::test
