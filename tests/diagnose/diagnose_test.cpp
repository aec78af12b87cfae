// SPDX-License-Identifier: MIT
// `sluice diagnose` and `sluice explain-finding` as programs: exit codes, text, JSON, trace, and what they leave
// behind.
#include <gmock/gmock.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "../cli/program.hpp"
#include "logs.hpp"
#include "sluice/ledger/finding.hpp"
#include "sluice/ledger/log.hpp"

namespace sluice::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Json = nlohmann::json;

class Diagnose : public ProgramTest {
  protected:
    void log(const std::string& name, Seeded seeded, std::uint32_t frames = 4) const {
        writeEngineLog(at(name).string(), frames, seeded);
    }
};

TEST_F(Diagnose, ACleanLogIsZero) {
    log("clean.log", Seeded::Nothing);
    const Outcome outcome = run("diagnose clean.log");
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("clean.log: clean"));
    EXPECT_THAT(outcome.out, HasSubstr("in 4 frames"));
    EXPECT_THAT(outcome.err, IsEmpty());
}

TEST_F(Diagnose, FindingsAreOne) {
    log("race.log", Seeded::MissingWait);
    const Outcome outcome = run("diagnose race.log");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.out, HasSubstr("race-read-after-write"));
    EXPECT_THAT(outcome.out, HasSubstr("remedy"));
    EXPECT_THAT(outcome.out, HasSubstr("edge"));
    EXPECT_EQ(run("diagnose race.log --quiet").out, "");
    EXPECT_EQ(run("diagnose race.log --quiet").code, 1);
}

TEST_F(Diagnose, AWaitForTheDeadShowsItsChain) {
    log("dead.log", Seeded::DeadWait);
    const Outcome outcome = run("diagnose dead.log");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.out, HasSubstr("wait-unsatisfiable"));
    EXPECT_THAT(outcome.out, HasSubstr("chain"));
}

TEST_F(Diagnose, UnreadableLogsAreTwoAndWriteNothing) {
    write("text.log", "this is no log at all, but it is long enough for a header");
    for (const char* words : {"diagnose missing.log --html a.html", "diagnose text.log --trace a.json",
                              "diagnose . --html a.html", "diagnose text.log --json"}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 2) << words << outcome.err;
        EXPECT_EQ(outcome.out, "") << words;
        EXPECT_FALSE(outcome.err.empty()) << words;
    }
    EXPECT_THAT(files(), ElementsAre("text.log"));
}

TEST_F(Diagnose, WrongCommandLinesAreOneWithNothingOnStdout) {
    log("a.log", Seeded::Nothing);
    for (const char* words : {"diagnose", "diagnose a.log --html a.log", "diagnose a.log --html b --trace b",
                              "diagnose a.log --frames 5..1 --html b", "diagnose a.log --json --quiet"}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 1) << words;
        EXPECT_EQ(outcome.out, "") << words;
        EXPECT_FALSE(outcome.err.empty()) << words;
    }
    EXPECT_THAT(files(), ElementsAre("a.log"));
}

TEST_F(Diagnose, AQueueThatNobodyHeardIsNotClean) {
    auto created = ledger::LogWriter::create(at("mute.log").string());
    ASSERT_TRUE(created);
    ledger::LogWriter& writer = *created.value();
    writer.declareActor(0, ledger::ActorKind::GlContext, "gl");
    writer.declareActor(1, ledger::ActorKind::VulkanQueue, "the queue");
    writer.declareResource(0, "colour", 1, ledger::kNoActor);
    ledger::Event write;
    write.kind = ledger::EventKind::Write;
    write.actor = 0;
    write.object = 0;
    write.frame = 1;
    writer.record(write);
    ASSERT_TRUE(writer.close());
    const Outcome outcome = run("diagnose mute.log");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("mute.log: clean as far as it was told\n"));
    EXPECT_THAT(outcome.out, HasSubstr("\nnot judged: the queue: is declared and does nothing here\n"));
    EXPECT_EQ(Json::parse(run("diagnose mute.log --json").out).at("unheard").size(), 1U);
}

TEST_F(Diagnose, FramesBeyondTheLogAreOneAndSaidWithWhatItHas) {
    log("a.log", Seeded::Nothing);
    EXPECT_EQ(run("diagnose a.log --frame 4").code, 0);
    EXPECT_EQ(run("diagnose a.log --frames 2..4 --html page.html").code, 0);
    for (const auto& [words, asked] : {std::pair{"--frame 5", "5 was asked for"},
                                       {"--frame 0", "0 was asked for"},
                                       {"--frames 3..9 --html b.html", "3..9 was asked for"},
                                       {"--frames 50 --json", "50..50 was asked for"}}) {
        const Outcome outcome = run(std::string("diagnose a.log ") + words);
        EXPECT_EQ(outcome.code, 1) << words;
        EXPECT_EQ(outcome.out, "") << words;
        EXPECT_THAT(outcome.err, AllOf(HasSubstr("a.log has frames 1 to 4"), HasSubstr(asked)));
    }
    EXPECT_THAT(files(), ElementsAre("a.log", "page.html"));
    EXPECT_EQ(run("diagnose a.log --frame -1").code, 1);
}

TEST_F(Diagnose, OutputsThatCannotBeWrittenAreFour) {
    log("a.log", Seeded::Nothing);
    const Outcome outcome = run("diagnose a.log --html /proc/no/page.html");
    EXPECT_EQ(outcome.code, 4);
    EXPECT_THAT(outcome.err, HasSubstr("/proc/no"));
}

TEST_F(Diagnose, ACutLogIsReadAndSaysSo) {
    log("a.log", Seeded::Nothing);
    const std::string bytes = read("a.log");
    write("cut.log", bytes.substr(0, bytes.size() - 20));
    const Outcome outcome = run("diagnose cut.log");
    EXPECT_NE(outcome.code, 2);
    EXPECT_THAT(outcome.out, HasSubstr("the log was cut off, not closed"));
}

TEST_F(Diagnose, ALogWithoutEventsIsTwoAndNotClean) {
    log("a.log", Seeded::Nothing);
    write("cut.log", read("a.log").substr(0, 40));
    ASSERT_TRUE(ledger::LogWriter::create(at("empty.log").string()));
    for (const auto& [words, why] : {std::pair{"diagnose cut.log --html a.html", "no event, the log was cut off"},
                                     {"diagnose empty.log --json", "no event was logged"}}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 2) << words;
        EXPECT_EQ(outcome.out, "") << words;
        EXPECT_THAT(outcome.err, HasSubstr(std::string("there is nothing to judge: ") + why));
    }
    EXPECT_THAT(files(), ElementsAre("a.log", "cut.log", "empty.log"));
}

TEST_F(Diagnose, ADamagedLogIsTwoWithThePlaceAndJudgesNothing) {
    log("a.log", Seeded::Nothing);
    std::string bytes = read("a.log");
    write("longer.log", bytes + "more");
    bytes.replace(bytes.size() / 2, 4, "XXXX");
    write("damaged.log", bytes);
    for (const char* name : {"damaged.log", "longer.log"}) {
        const Outcome outcome = run(std::string("diagnose --html a.html ") + name);
        EXPECT_EQ(outcome.code, 2) << name;
        EXPECT_EQ(outcome.out, "") << name;
        EXPECT_THAT(outcome.err, HasSubstr(std::string("sluice: error: ") + name + ": at byte "));
    }
    EXPECT_THAT(files(), ElementsAre("a.log", "damaged.log", "longer.log"));
}

TEST_F(Diagnose, AWaitAtTheCutIsSaidToBePerhapsNothing) {
    {
        auto created = ledger::LogWriter::create(at("a.log").string());
        ASSERT_TRUE(created);
        created.value()->declareActor(0, ledger::ActorKind::GlContext, "gl");
        created.value()->declareActor(1, ledger::ActorKind::VulkanQueue, "the queue");
        created.value()->declareSync(0, ledger::SyncKind::Timeline, "drawn", 0, 0);
        ledger::Event event;
        event.actor = 0;
        event.object = 0;
        event.frame = 1;
        event.value = 1;
        event.kind = ledger::EventKind::Signal;
        created.value()->record(event);
        event.kind = ledger::EventKind::Wait;
        event.actor = 1;
        event.value = 2;
        created.value()->record(event);
    }
    const std::string bytes = read("a.log");
    write("cut.log", bytes.substr(0, bytes.size() - 16));
    const Outcome outcome = run("diagnose cut.log");
    EXPECT_EQ(outcome.code, 1) << outcome.out;
    EXPECT_THAT(outcome.out, HasSubstr("remedy  The log was cut here, so nothing need be wrong: "));
    EXPECT_THAT(run("diagnose a.log").out, Not(HasSubstr("The log was cut here")));
}

TEST_F(Diagnose, JsonHoldsFindingsAndReport) {
    log("race.log", Seeded::MissingWait);
    const Outcome outcome = run("diagnose race.log --json");
    EXPECT_EQ(outcome.code, 1);
    const Json json = Json::parse(outcome.out);
    EXPECT_EQ(json["verdict"], "findings");
    EXPECT_EQ(json["closed"], true);
    EXPECT_EQ(json["errors"].get<int>() > 0, true);
    EXPECT_EQ(json["actors"].size(), 3U);
    std::set<std::string> ids;
    std::uint64_t counted = 0;
    for (const Json& finding : json["findings"]) {
        if (finding["severity"] == "info") {
            continue;
        }
        ids.insert(finding["id"].get<std::string>());
        counted += finding["count"].get<std::uint64_t>();
        EXPECT_THAT(finding["sentence"].get<std::string>(), HasSubstr("colour"));
        EXPECT_FALSE(finding["remedy"].get<std::string>().empty());
        EXPECT_EQ(finding["first"]["actor"], "gl </script><b>bold</b>");
        EXPECT_EQ(finding["second"]["actor"], "queue");
        EXPECT_EQ(finding["second"]["kind"], "read");
        EXPECT_EQ(finding["second"]["object"], "colour");
    }
    EXPECT_THAT(ids, ElementsAre("race-read-after-write"));
    EXPECT_EQ(counted, 4U) << "once in each frame";
}

TEST_F(Diagnose, JsonReportIsThatOfTheArithmetic) {
    log("clean.log", Seeded::Nothing);
    const Json report = Json::parse(run("diagnose clean.log --json").out)["report"];
    ASSERT_EQ(report["frames"].size(), 4U);
    // The thread waits from 450 us to 600 us for what the queue signals at 560 us; frames begin 1 ms apart.
    EXPECT_EQ(report["wake_up_ns"]["count"], 4);
    EXPECT_EQ(report["wake_up_ns"]["median"], 40000);
    EXPECT_EQ(report["frame_ns"]["max"], 600000);
    EXPECT_EQ(report["stalls"][0]["waiting"], "engine thread");
    EXPECT_EQ(report["stalls"][0]["total_ns"], 4 * 150000);
    const Json& frame = report["frames"][1];
    EXPECT_EQ(frame["frame"], 2);
    EXPECT_EQ(frame["begin_ns"], 1000000);
    std::vector<std::string> path;
    for (const Json& part : frame["critical_path"]) {
        path.push_back(part["actor"].get<std::string>());
    }
    EXPECT_THAT(path, ElementsAre("engine thread", "queue", "engine thread"));
    // Busy: thread 0..450 us, gl from its submission 20..230, queue from its own 245..560: 975 us in all, 560 of them
    // covered, 450 the longest.
    EXPECT_EQ(frame["overlap_possible_ns"], 525000);
    EXPECT_EQ(frame["overlap_achieved_ns"], 415000);
}

TEST_F(Diagnose, TheTextNamesOneFrameOnRequest) {
    log("clean.log", Seeded::Nothing);
    EXPECT_THAT(run("diagnose clean.log").out, HasSubstr("(the longest)"));
    EXPECT_THAT(run("diagnose clean.log --frame 3").out, HasSubstr("frame 3: 600.0 us long"));
}

TEST_F(Diagnose, TheTraceHasTracksSlicesArrowsAndFindings) {
    log("race.log", Seeded::MissingWait);
    EXPECT_EQ(run("diagnose race.log --quiet --trace race.json").code, 1);
    const Json trace = Json::parse(read("race.json"));
    std::map<std::string, int> phases;
    std::map<int, std::pair<double, double>> arrows;  // by id: begin, end
    std::set<std::string> tracks;
    double stall = 0;
    for (const Json& event : trace["traceEvents"]) {
        const std::string phase = event["ph"];
        ++phases[phase];
        if (phase == "s") {
            arrows[event["id"]].first = event["ts"];
        } else if (phase == "f") {
            arrows[event["id"]].second = event["ts"];
        } else if (event["name"] == "thread_name") {
            tracks.insert(event["args"]["name"].get<std::string>());
        } else if (phase == "i") {
            EXPECT_EQ(event["name"], "race-read-after-write");
            EXPECT_EQ(event["tid"], 3) << "on the queue's track";
        } else if (phase == "X" && event["cat"] == "wait") {
            stall += event["dur"].get<double>();
        }
    }
    EXPECT_THAT(tracks, ElementsAre("engine thread", "gl </script><b>bold</b>", "queue"));
    EXPECT_EQ(phases["s"], 4) << "the thread's waits; the queue has none";
    EXPECT_EQ(phases["f"], 4);
    EXPECT_GE(phases["i"], 1);
    EXPECT_DOUBLE_EQ(stall, 4 * 150.0);
    for (const auto& [id, ends] : arrows) {
        EXPECT_LE(ends.first, ends.second) << "no arrow points back in time";
    }
    EXPECT_THAT(files(), ElementsAre("race.json", "race.log"));
}

TEST_F(Diagnose, ExplainFindingKnowsEveryKind) {
    const Outcome list = run("explain-finding");
    EXPECT_EQ(list.code, 0);
    for (std::size_t i = 0; i < ledger::kFindingKindCount; ++i) {
        const ledger::FindingInfo& info = ledger::findingInfo(static_cast<ledger::FindingKind>(i));
        EXPECT_THAT(list.out, HasSubstr(std::string(info.id)));
        const Outcome one = run("explain-finding " + std::string(info.id));
        EXPECT_EQ(one.code, 0) << info.id;
        EXPECT_THAT(one.out, HasSubstr(std::string(info.meaning)));
        EXPECT_THAT(one.out, HasSubstr(std::string(info.remedy)));
    }
    EXPECT_EQ(Json::parse(run("explain-finding --json").out).size(), ledger::kFindingKindCount);
    EXPECT_EQ(Json::parse(run("explain-finding stale-read --json").out)["id"], "stale-read");
    const Outcome unknown = run("explain-finding race");
    EXPECT_EQ(unknown.code, 1);
    EXPECT_THAT(unknown.err, HasSubstr("'race': no kind of finding has that id"));
    EXPECT_THAT(run("explain-finding stale-raed").err, HasSubstr("has that id; the nearest is 'stale-read'"));
    const std::string help = run("explain-finding --help").out;
    EXPECT_THAT(help, HasSubstr("Usage: sluice explain-finding [ID] [OPTIONS]\n"));
    EXPECT_THAT(help, HasSubstr("Exit codes of explain-finding:\n  0 "));
    EXPECT_THAT(help, Not(HasSubstr("particles")));
}

/// The program of samples/trace_your_engine, which is C and knows nothing of Sluice but its header.
TEST_F(Diagnose, TheSampleEngineIsToldItsMissingWait) {
    const auto sample = [this](const std::string& words) {
        return std::system(("cd '" + at("").string() + "' && '" SLUICE_SAMPLE_ENGINE "' " + words).c_str());
    };
    ASSERT_EQ(sample("broken.log"), 0);
    ASSERT_EQ(sample("fixed.log --fixed"), 0);
    EXPECT_NE(sample("--fixed 2>/dev/null"), 0) << "a log of that name was not meant";
    EXPECT_FALSE(exists("--fixed"));
    const Outcome broken = run("diagnose broken.log --json");
    EXPECT_EQ(broken.code, 1);
    std::set<std::string> ids;
    const Json json = Json::parse(broken.out);
    for (const Json& finding : json["findings"]) {
        if (finding["severity"] != "info") {
            ids.insert(finding["id"].get<std::string>());
        }
    }
    // The forgotten wait also lets the queue overwrite its result while OpenGL reads the one before.
    EXPECT_THAT(ids, ElementsAre("race-read-after-write", "race-write-after-read"));
    const Outcome fixed = run("diagnose fixed.log");
    EXPECT_EQ(fixed.code, 0) << fixed.out;
}

}  // namespace
}  // namespace sluice::test
