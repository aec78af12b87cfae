// SPDX-License-Identifier: MIT
// `sluice stress` from the command line: what it refuses, what it prints, what it leaves behind.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace sluice::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

class Stress : public ProgramTest {};

TEST_F(Stress, WrongValuesAreAnsweredWithTheRightOnes) {
    const auto answer = [this](const std::string& words) {
        const Outcome outcome = run("stress " + words);
        EXPECT_EQ(outcome.code, 1) << words;
        EXPECT_THAT(outcome.out, IsEmpty());
        return outcome.err;
    };
    EXPECT_THAT(answer("--pattern round"),
                AllOf(HasSubstr("--pattern: expected one of gl-to-vk"), HasSubstr("found \"round\"")));
    EXPECT_THAT(answer("--fault shuffle"), HasSubstr("wrong-layout, all, found \"shuffle\""));
    EXPECT_THAT(answer("--handoffs 0"), HasSubstr("--handoffs: expected a whole number above 0, found \"0\""));
    EXPECT_THAT(answer("--seconds -1"), HasSubstr("--seconds: expected seconds above 0"));
    EXPECT_THAT(answer("--seconds 1 --handoffs 1"), HasSubstr("excludes"));
    EXPECT_THAT(
        answer("--backend finish --topology two-processes"),
        AllOf(StartsWith("sluice: error: --backend finish --topology two-processes: "), HasSubstr("take bridged")));
    EXPECT_THAT(answer("--resource buffer --fault wrong-layout"),
                StartsWith("sluice: error: --resource buffer --fault wrong-layout: a buffer has no layout"));
    EXPECT_THAT(answer("--backend finish --topology bridge-thread"), HasSubstr("finish has no bridge"));
    EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Stress, ABackendThatIsNotHereIsRefusedByName) {
    const Outcome outcome = run("stress --pattern ping-pong --resource colour --backend native");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("native"), HasSubstr("--backend bridged or finish"),
                                   HasSubstr("; 2 of 2 combinations cannot run here\n")));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << "once, not for each: " << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("no combination ran; seed 1\n"));
}

TEST_F(Stress, ACleanRunIsATableAndCodeZero) {
    const Outcome outcome = run("stress --pattern ring --resource D32F --handoffs 300");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("ring"), HasSubstr("clean"), HasSubstr("0 of 4 combinations failed")));
    EXPECT_EQ(outcome.err, "");
    EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Stress, JsonHoldsTheFaultsAndWhoSawThem) {
    const Outcome outcome =
        run("stress --pattern ping-pong --resource buffer --backend bridged --topology all --fault duplicate "
            "--handoffs 300 "
            "--seed 5 --json");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const auto document = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(document.at("seed"), 5);
    ASSERT_THAT(document.at("combinations"), SizeIs(3));
    for (const auto& one : document.at("combinations")) {
        EXPECT_EQ(one.at("verdict"), "seen");
        EXPECT_GE(one.at("handoffs"), 100);
        EXPECT_GE(one.at("faults").at("injected"), 1);
        EXPECT_EQ(one.at("faults").at("by_ledger"), one.at("faults").at("injected"));
        EXPECT_EQ(one.at("faults").at("refused_by_guard"), one.at("faults").at("injected"));
        EXPECT_TRUE(one.at("failure").is_null());
    }
    EXPECT_THAT(document.at("left_out"), IsEmpty());
}

TEST_F(Stress, ALogThatCannotBeWrittenEndsTheRunBeforeItBegins) {
    const std::string words = "stress --pattern ring --resource R32F --handoffs 100 --log ";
    ASSERT_EQ(run(words + "new/kept.sluicelog").code, 0);
    EXPECT_THAT(files(), IsEmpty());  // not even the folder: nothing failed
    write("file.txt", "");
    for (const char* path : {"file.txt/kept.sluicelog", "."}) {
        const Outcome outcome = run(words + path);
        EXPECT_EQ(outcome.code, 4) << path;
        EXPECT_THAT(outcome.out, IsEmpty());
        EXPECT_THAT(outcome.err, HasSubstr(path));
    }
}

TEST_F(Stress, AnInterruptEndsTheRunWithItsTable) {
    const Outcome outcome = run("stress --pattern ping-pong --resource R32F --backend bridged --seconds 500",
                                "timeout --foreground --preserve-status --signal INT 3");
    EXPECT_EQ(outcome.code, 130);
    EXPECT_THAT(outcome.out, HasSubstr("interrupted"));
    EXPECT_EQ(outcome.err, "");
}

}  // namespace
}  // namespace sluice::test
