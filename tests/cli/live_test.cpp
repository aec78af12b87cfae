// SPDX-License-Identifier: MIT
// `sluice render` of a scene that is simulated: the pictures are those of the files that `sluice simulate` writes.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "program.hpp"

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

TEST_F(Live, TheLedgerFindsAFrameThatDoesNotWaitForItsFluid) {
    writeFluid("s.json");
    const nlohmann::json faulty = render("s.json -o f_##.png --fault skip-wait/simulation@3 --ledger");
    const std::string findings = faulty["ledger"]["findings"].dump();
    EXPECT_THAT(findings, AllOf(HasSubstr("output slot"), HasSubstr("simulation"))) << findings;
    EXPECT_EQ(run("render s.json -o f_##.png --fault drop/simulation@3").code, 1);
}

TEST_F(Live, AFluidThatIsTooFastStandsStillAndALostRendererBeginsAgain) {
    writeFluid("fast.json", "[0, -10000, 0]");
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
    write("tap.json", R"({"simulation": {"fluid": [{"low": [-0.6, 0.5, -0.4], "high": [0.2, 1.1, 0.4],
                                                    "velocity": [0, 0, 0]}],
                                         "drains": [{"shape": "sphere", "centre": [0, 0.2, 0], "half": [0.1, 0.1, 0.1]}]}})");
    const Outcome tap = run("render tap.json -o f.png");
    EXPECT_EQ(tap.code, 2);
    EXPECT_THAT(tap.err, HasSubstr("/simulation/drains"));
    EXPECT_THAT(run("explain s.json").out, HasSubstr("384 particles"));
}

}  // namespace
}  // namespace sluice::test
