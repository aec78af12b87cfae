// SPDX-License-Identifier: MIT
// The trace file as its readers see it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "sluice/trace.hpp"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sluice::TraceRecord;
using ::testing::HasSubstr;

TraceRecord record(SluiceTraceKind kind, SluiceTrack track, SluiceDirection direction, std::uint64_t value,
                   std::uint64_t begin_ns, std::uint64_t duration_ns, std::string_view name = "") {
    TraceRecord r{};
    r.kind = kind;
    r.track = track;
    r.direction = direction;
    r.value = value;
    r.frame = (value + 1) / 2;
    r.bytes = value * 10;
    r.begin_ns = begin_ns;
    r.duration_ns = duration_ns;
    std::memcpy(r.name.data(), name.data(), std::min(name.size(), r.name.size() - 1));
    return r;
}

json written(const std::vector<TraceRecord>& records, std::uint64_t dropped = 0) {
    std::ostringstream out;
    sluice::writeChromeTrace(out, records, dropped);
    return json::parse(out.str());
}

std::vector<json> phase(const json& trace, std::string_view ph) {
    std::vector<json> events;
    for (const json& event : trace.at("traceEvents")) {
        if (event.at("ph") == ph) {
            events.push_back(event);
        }
    }
    return events;
}

/// One frame as the bridged timeline records it.
std::vector<TraceRecord> oneFrame() {
    return {
        record(SLUICE_TRACE_SIGNAL, SLUICE_TRACK_HOST_GL, SLUICE_HOST_TO_RENDERER, 1, 5'000'001'000, 2'000, "captured"),
        record(SLUICE_TRACE_WAIT, SLUICE_TRACK_RENDERER_QUEUE, SLUICE_HOST_TO_RENDERER, 1, 5'000'004'123, 0),
        record(SLUICE_TRACE_SIGNAL, SLUICE_TRACK_RENDERER_QUEUE, SLUICE_RENDERER_TO_HOST, 1, 5'000'020'000, 0),
        record(SLUICE_TRACE_WAIT, SLUICE_TRACK_HOST_GL, SLUICE_RENDERER_TO_HOST, 1, 5'000'010'000, 11'000),
        record(SLUICE_TRACE_PASS, SLUICE_TRACK_RENDERER_QUEUE, SLUICE_HOST_TO_RENDERER, 0, 5'000'005'000, 14'000,
               "splat"),
    };
}

TEST(ChromeTrace, NamesEveryTrackAsAThread) {
    std::map<int, std::string> names;
    for (const json& event : phase(written({}), "M")) {
        if (event.at("name") == "thread_name") {
            names[event.at("tid").get<int>()] = event.at("args").at("name").get<std::string>();
        }
    }
    EXPECT_EQ(names.size(), static_cast<std::size_t>(SLUICE_TRACK_COUNT));
    EXPECT_EQ(names.at(SLUICE_TRACK_HOST_GL + 1), "host GL");
    EXPECT_EQ(names.at(SLUICE_TRACK_RENDERER_QUEUE + 1), "renderer queue");
}

TEST(ChromeTrace, KeepsNanosecondsAndStartsAtTheFirstEvent) {
    const auto slices = phase(written(oneFrame()), "X");
    ASSERT_EQ(slices.size(), 5U);
    EXPECT_DOUBLE_EQ(slices[0].at("ts").get<double>(), 0.0);
    EXPECT_DOUBLE_EQ(slices[0].at("dur").get<double>(), 2.0);
    EXPECT_DOUBLE_EQ(slices[1].at("ts").get<double>(), 3.123);
    EXPECT_EQ(slices[0].at("name"), "captured");
    EXPECT_EQ(slices[0].at("cat"), "signal");
    EXPECT_EQ(slices[0].at("args").at("value"), 1);
    EXPECT_EQ(slices[0].at("args").at("frame"), 1);
    EXPECT_EQ(slices[0].at("args").at("bytes"), 10);
    EXPECT_EQ(slices[0].at("args").at("direction"), "host to renderer");
    EXPECT_EQ(slices[1].at("name"), "wait") << "a nameless event is called by its kind";
    EXPECT_FALSE(slices[4].at("args").contains("direction")) << "a pass has none";
}

TEST(ChromeTrace, ArrowsRunFromEachSignalToItsWaitsInsideTheirSlices) {
    const json trace = written(oneFrame());
    const auto starts = phase(trace, "s");
    const auto ends = phase(trace, "f");
    ASSERT_EQ(starts.size(), 2U);
    ASSERT_EQ(ends.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(starts[i].at("id"), ends[i].at("id"));
        EXPECT_EQ(starts[i].at("name"), ends[i].at("name"));
        EXPECT_EQ(starts[i].at("cat"), ends[i].at("cat"));
        EXPECT_EQ(ends[i].at("bp"), "e");
        EXPECT_LE(starts[i].at("ts").get<double>(), ends[i].at("ts").get<double>()) << "arrows do not run back in time";
    }
    EXPECT_NE(starts[0].at("id"), starts[1].at("id"));
    EXPECT_EQ(starts[0].at("tid"), SLUICE_TRACK_HOST_GL + 1);
    EXPECT_EQ(ends[0].at("tid"), SLUICE_TRACK_RENDERER_QUEUE + 1);
    EXPECT_DOUBLE_EQ(ends[1].at("ts").get<double>(), 19.0) << "the wait began before the signal and ended after it";
}

TEST(ChromeTrace, NoArrowWithoutBothEnds) {
    std::vector<TraceRecord> records = oneFrame();
    records[1].value = 3;                            // waits for what nobody signalled
    records[3].direction = SLUICE_HOST_TO_RENDERER;  // the value is signalled, but the other way
    records[3].value = 99;
    const json trace = written(records);
    EXPECT_TRUE(phase(trace, "s").empty());
    EXPECT_TRUE(phase(trace, "f").empty());
    EXPECT_EQ(phase(trace, "X").size(), records.size());
}

TEST(ChromeTrace, OneSignalReachesSeveralWaits) {
    std::vector<TraceRecord> records = oneFrame();
    records.push_back(records[1]);
    records.back().begin_ns += 50'000;
    std::set<std::uint64_t> ids;
    for (const json& end : phase(written(records), "f")) {
        ids.insert(end.at("id").get<std::uint64_t>());
    }
    EXPECT_EQ(ids.size(), 3U) << "every arrow has its own id";
}

TEST(ChromeTrace, TellsHowManyEventsAreMissing) {
    EXPECT_EQ(written(oneFrame(), 42).at("otherData").at("dropped"), 42);
    EXPECT_EQ(written({}, 0).at("otherData").at("dropped"), 0);
}

TEST(ChromeTrace, EscapesEveryName) {
    const std::string hostile = "a\"b\\c\n\t\x01</script>";
    const json trace =
        written({record(SLUICE_TRACE_MARK, SLUICE_TRACK_HOST_CPU, SLUICE_HOST_TO_RENDERER, 0, 1, 1, hostile)});
    EXPECT_EQ(phase(trace, "X").at(0).at("name"), hostile);
}

TEST(ChromeTrace, ANameCutInsideACharacterStaysValidJson) {
    const json trace = written({record(SLUICE_TRACE_MARK, SLUICE_TRACK_HOST_CPU, SLUICE_HOST_TO_RENDERER, 0, 1, 1,
                                       "012345678901234567890123456\xe2\x82\xac\xe2")});
    EXPECT_THAT(phase(trace, "X").at(0).at("name").get<std::string>(), HasSubstr("\xe2\x82\xac\xef\xbf\xbd"));
}

TEST(ChromeTrace, HugeTimesAreNotRounded) {
    const std::uint64_t begin = 0xffff'ffff'ffff'0000ULL;
    std::ostringstream out;
    sluice::writeChromeTrace(out,
                             {record(SLUICE_TRACE_MARK, SLUICE_TRACK_HOST_CPU, SLUICE_HOST_TO_RENDERER, 0, 0, 1),
                              record(SLUICE_TRACE_MARK, SLUICE_TRACK_HOST_CPU, SLUICE_HOST_TO_RENDERER, 0, begin, 1)},
                             0);
    EXPECT_THAT(out.str(), HasSubstr("\"ts\":18446744073709486.080"));
}

RC_GTEST_PROP(ChromeTrace, AnyRecordsGiveJsonWithOneSlicePerRecordAndArrowsForExactlyTheMatches, ()) {
    std::vector<TraceRecord> records;
    const auto count = *rc::gen::inRange(0, 20);
    for (int i = 0; i < count; ++i) {
        records.push_back(record(static_cast<SluiceTraceKind>(*rc::gen::inRange(0, 4)),
                                 static_cast<SluiceTrack>(*rc::gen::inRange<int>(0, SLUICE_TRACK_COUNT)),
                                 static_cast<SluiceDirection>(*rc::gen::inRange(0, 2)),
                                 *rc::gen::inRange<std::uint64_t>(0, 4), *rc::gen::arbitrary<std::uint32_t>(),
                                 *rc::gen::arbitrary<std::uint32_t>(), *rc::gen::arbitrary<std::string>()));
    }
    std::size_t matches = 0;
    for (const TraceRecord& signal : records) {
        for (const TraceRecord& wait : records) {
            matches += signal.kind == SLUICE_TRACE_SIGNAL && wait.kind == SLUICE_TRACE_WAIT &&
                               signal.direction == wait.direction && signal.value == wait.value
                           ? 1U
                           : 0U;
        }
    }
    const json trace = written(records);
    RC_ASSERT(phase(trace, "X").size() == records.size());
    const auto starts = phase(trace, "s");
    const auto ends = phase(trace, "f");
    RC_ASSERT(starts.size() == matches);
    RC_ASSERT(ends.size() == matches);
    std::map<std::uint64_t, std::string> open;
    for (const json& start : starts) {
        RC_ASSERT(open.emplace(start.at("id").get<std::uint64_t>(), start.at("name").get<std::string>()).second);
    }
    for (const json& end : ends) {
        RC_ASSERT(open.at(end.at("id").get<std::uint64_t>()) == end.at("name").get<std::string>());
    }
}

class TraceFile : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "sluice-trace-XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override {
        fs::permissions(folder_, fs::perms::owner_all);
        fs::remove_all(folder_);
    }
    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    fs::path folder_;
};

TEST_F(TraceFile, IsWrittenWhole) {
    const fs::path path = folder_ / "trace.json";
    const auto status = sluice::writeChromeTraceFile(path.string(), oneFrame(), 0);
    ASSERT_TRUE(status.ok()) << status.error().message();
    std::ifstream in(path);
    EXPECT_EQ(phase(json::parse(in), "X").size(), 5U);
    EXPECT_EQ(entries(), 1U) << "no temporary file is left";
}

TEST_F(TraceFile, ReplacesAnEarlierOne) {
    const fs::path path = folder_ / "trace.json";
    std::ofstream(path) << "old";
    ASSERT_TRUE(sluice::writeChromeTraceFile(path.string(), {}, 7).ok());
    std::ifstream in(path);
    EXPECT_EQ(json::parse(in).at("otherData").at("dropped"), 7);
    EXPECT_EQ(entries(), 1U);
}

TEST_F(TraceFile, MissingFolderIsNamedWithItsErrno) {
    const std::string path = (folder_ / "nowhere" / "trace.json").string();
    const auto status = sluice::writeChromeTraceFile(path, oneFrame(), 0);
    ASSERT_FALSE(status.ok());
    EXPECT_THAT(status.error().message(), HasSubstr(path));
    EXPECT_THAT(status.error().message(), HasSubstr("No such file or directory"));
    EXPECT_THAT(status.error().message(), HasSubstr("errno 2"));
    EXPECT_FALSE(status.error().remedy.empty());
    EXPECT_EQ(entries(), 0U);
}

TEST_F(TraceFile, AFailedRenameLeavesNothingBehind) {
    const fs::path path = folder_ / "trace.json";
    fs::create_directory(path);  // a file cannot replace a folder
    const auto status = sluice::writeChromeTraceFile(path.string(), oneFrame(), 0);
    ASSERT_FALSE(status.ok());
    EXPECT_THAT(status.error().message(), HasSubstr("rename"));
    EXPECT_EQ(entries(), 1U) << "only the folder that was there";
}

TEST_F(TraceFile, AFullDiskIsNamed) {
    // The temporary file of this process is made a link to the device that is always full.
    const fs::path path = folder_ / "trace.json";
    fs::create_symlink("/dev/full", path.string() + "." + std::to_string(getpid()) + ".partial");
    const auto status = sluice::writeChromeTraceFile(path.string(), oneFrame(), 0);
    ASSERT_FALSE(status.ok());
    EXPECT_THAT(status.error().message(), HasSubstr("No space left on device"));
    EXPECT_EQ(entries(), 0U);
}

}  // namespace
