// SPDX-License-Identifier: MIT
// render --ledger, --ledger-log and --fault: what the user sees.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "app/parse_values.hpp"
#include "program.hpp"

namespace sluice::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ParseFault, KnowsEveryKindItsDirectionAndItsValue) {
    for (const auto& [name, kind] : host::kFaultNames) {
        const auto plan = cli::parseFault(std::string(name) + "@5");
        ASSERT_TRUE(plan) << plan.error().message();
        EXPECT_EQ(plan.value().kind, kind);
        EXPECT_EQ(plan.value().frame, 5U);
        const bool about_waits = kind == host::FaultKind::SkipWait || kind == host::FaultKind::EarlyReuse;
        EXPECT_EQ(plan.value().direction, about_waits ? SLUICE_RENDERER_TO_HOST : SLUICE_HOST_TO_RENDERER);
    }
    EXPECT_EQ(cli::parseFault("delay/to-host@2=250").value().value, 250U);
    EXPECT_EQ(cli::parseFault("delay/to-host@2=250").value().direction, SLUICE_RENDERER_TO_HOST);
    EXPECT_EQ(cli::parseFault("skip-wait/to-renderer@2").value().direction, SLUICE_HOST_TO_RENDERER);
}

TEST(ParseFault, RefusesWhatIsNoFault) {
    for (const char* text :
         {"", "drop", "@5", "drop@", "drop@0", "drop@-1", "drop@5=", "drop@5=x", "lose@5", "drop/@5", "drop/to-gl@5",
          "swap/to-host@5", "duplicate/to-host@5", "early-reuse/to-renderer@5", "=3@5", "drop=3@5"}) {
        EXPECT_FALSE(cli::parseFault(text)) << text;
    }
}

TEST(ParseFault, KnowsTheHostFaults) {
    for (const auto& [name, kind] : host::kHostFaultNames) {
        const std::string text = std::string(name) + "@5=7";
        EXPECT_TRUE(cli::namesHostFault(text));
        const auto fault = cli::parseHostFault(text);
        ASSERT_TRUE(fault) << fault.error().message();
        EXPECT_EQ(fault.value().kind, kind);
        EXPECT_EQ(fault.value().frame, 5U);
        EXPECT_EQ(fault.value().value, 7U);
    }
    EXPECT_FALSE(cli::namesHostFault("drop@5"));
    for (const char* text :
         {"", "hang", "hang@", "hang@0", "hang@1=", "hang@1=x", "hang=1@1", "drop@1", "hang/to-host@1"}) {
        EXPECT_FALSE(cli::parseHostFault(text)) << text;
    }
    EXPECT_THAT(cli::parseFault("lose@5").error().message(), HasSubstr("device-lost"));
}

TEST(ParseDeadline, IsSecondsWithinReason) {
    EXPECT_EQ(cli::parseDeadline("0.5").value(), 0.5);
    for (const char* text : {"", "0", "-1", "nan", "inf", "3601", "1s"}) {
        EXPECT_FALSE(cli::parseDeadline(text)) << text;
    }
}

class LedgerOption : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        writeParticles("p.pos", 4);
        writeScene("s.json", "p.pos");
    }
};

TEST_F(LedgerOption, CleanFramesEndWithOneLineAndTheLogIsClean) {
    const Outcome outcome = run("render s.json -o a_####.png --frames 1..4 --ledger-log a.log");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("ledger: "));
    EXPECT_THAT(outcome.out, HasSubstr(" events, no finding\n"));
    const Outcome diagnosed = run("diagnose a.log");
    EXPECT_EQ(diagnosed.code, 0) << diagnosed.out << diagnosed.err;
}

TEST_F(LedgerOption, WithoutARendererItSaysThatNothingWasChecked) {
    const Outcome text = run("render s.json -o a.png --no-fluid --ledger");
    EXPECT_EQ(text.code, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("ledger: not checked: no frame was handed to a renderer\n"));
    const Outcome json = run("render s.json -o a.png --plugin /no/such.so --ledger --json");
    EXPECT_EQ(json.code, 3);
    EXPECT_EQ(nlohmann::json::parse(json.out).at("ledger").at("unchecked").at("since_frame"), 1);
}

TEST_F(LedgerOption, WithoutItTheSummaryHasNone) {
    const Outcome outcome = run("render s.json -o a.png --json");
    EXPECT_TRUE(nlohmann::json::parse(outcome.out).at("ledger").is_null());
}

TEST_F(LedgerOption, ASkippedWaitIsInTheJsonAndTheExitCodeStays) {
    const Outcome outcome =
        run("render s.json -o a_####.png --frames 1..4 --image-sets 1 --ledger-log a.log --fault skip-wait@2 --json");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const auto ledger = nlohmann::json::parse(outcome.out).at("ledger");
    std::vector<std::string> ids;
    for (const auto& finding : ledger.at("findings")) {
        ids.push_back(finding.at("id"));
        EXPECT_FALSE(finding.at("remedy").get<std::string>().empty());
    }
    EXPECT_THAT(ids, Contains("race-write-after-write"));
    EXPECT_GT(ledger.at("events"), 50);
    const Outcome diagnosed = run("diagnose a.log");
    EXPECT_EQ(diagnosed.code, 1);
    EXPECT_THAT(diagnosed.out, HasSubstr("GL stream acquires HOST_COLOUR of set 0 in frame 2, but nothing orders that "
                                         "after the release by renderer's queue in frame 2."));
    EXPECT_THAT(diagnosed.out, HasSubstr("wait for renderer-to-host >= 2 before the acquire of HOST_COLOUR of set 0 by "
                                         "GL stream"));
}

TEST_F(LedgerOption, ADroppedSignalCostsOneFrameItsFluidAndTheLogTellsWhoWaitsForWhom) {
    const Outcome outcome = run(
        "render s.json -o a_####.png --frames 1..5 --timeline bridged --ledger --fault drop@2 --deadline 1.5 --json");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("watchdog: the host has waited 1.5"));
    EXPECT_THAT(outcome.err, HasSubstr("nobody has promised host-to-renderer 3: its signal was never recorded"));
    const auto frames = nlohmann::json::parse(outcome.out).at("frames");
    EXPECT_EQ(frames.at("written"), 5);
    EXPECT_EQ(frames.at("with_fluid"), 4);
}

TEST_F(LedgerOption, ALostDeviceCostsOneFrameItsFluidAndAnotherRendererGoesOn) {
    const Outcome outcome =
        run("render s.json -o a_####.png --frames 1..4 --fault device-lost@2 --json -v --ledger-log a.log");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("renderer: here again after 1 frame without fluid"));
    const auto frames = nlohmann::json::parse(outcome.out).at("frames");
    EXPECT_EQ(frames.at("written"), 4);
    EXPECT_EQ(frames.at("with_fluid"), 3);
    const auto log = nlohmann::json::parse(run("diagnose a.log --json").out);
    EXPECT_EQ(log.at("report").at("frames").size(), 4U) << "the frames of both renderers, as the host counts them";
    std::vector<std::string> actors;
    for (const auto& actor : log.at("actors")) {
        actors.push_back(actor.at("name"));
    }
    EXPECT_THAT(actors, Contains("renderer's queue"));
    EXPECT_THAT(actors, Contains("renderer's queue, 2nd renderer"));
    const Outcome late = run("render s.json -o b.png --fault device-lost@9");
    EXPECT_EQ(late.code, 0) << late.err;
    EXPECT_THAT(late.err, HasSubstr("never came"));
}

TEST_F(LedgerOption, AFaultThatWouldHangOrNeverComesIsSaid) {
    const Outcome hangs = run("render s.json -o a.png --timeline native --fault drop@1");
    EXPECT_EQ(hangs.code, 1);
    EXPECT_THAT(hangs.err, HasSubstr("--timeline bridged"));
    const Outcome late = run("render s.json -o a_####.png --frames 1..2 --fault drop@9");
    EXPECT_EQ(late.code, 0) << late.err;
    EXPECT_THAT(late.err, HasSubstr("fault drop: frame 9 never came, the last one was 2"));
    const Outcome skipped = run("render s.json -o a_####.png --frames 1..2 --fault skip-wait@2");
    EXPECT_EQ(skipped.code, 0) << skipped.err;
    EXPECT_THAT(skipped.err, HasSubstr("--fault: injected in frame 2\n"));
    const Outcome nobody = run("render s.json -o a.png --plugin /no/x.so --fault drop@1");
    EXPECT_EQ(nobody.code, 3);
    EXPECT_THAT(nobody.err, HasSubstr("nothing was injected"));
    EXPECT_EQ(run("render s.json -o a.png --no-fluid --fault drop@1").code, 1);
}

TEST_F(LedgerOption, FluidThatWasLostIsCountedAndItsMessageIsForTheUser) {
    const Outcome outcome = run("render s.json -o a_####.png --frames 1..4 --fault context-lost@3");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.out, HasSubstr("4 of 4 frames (2 with fluid), "));
    EXPECT_THAT(outcome.out, HasSubstr("problem: frame 3: GL context"));
    EXPECT_THAT(outcome.out + outcome.err, Not(HasSubstr("FluidHost")));
    const Outcome quiet = run("render s.json -o a_####.png --frames 1..4 --fault context-lost@3 --quiet");
    EXPECT_THAT(quiet.err, HasSubstr("GL context"));
    const Outcome fds = run("render s.json -o a_####.png --frames 1..3 --fault out-of-fds@2");
    EXPECT_THAT(fds.err, HasSubstr("the injected fault has lowered their limit"));
}

TEST_F(LedgerOption, ALogThatCannotBeWrittenIsSaidBeforeAnyWork) {
    EXPECT_EQ(run("render s.json -o a.png --ledger-log p.pos").code, 1) << "an input";
    EXPECT_EQ(run("render s.json -o a.png --ledger-log s.json/a.log").code, 4);
    EXPECT_THAT(files(), ::testing::ElementsAre("p.pos", "s.json"));
}

}  // namespace
}  // namespace sluice::test
