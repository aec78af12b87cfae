// SPDX-License-Identifier: MIT
// sluice_trace.h from C99: the log that it writes, what the ledger finds in it, and that nothing in is nothing out.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "log_bytes.hpp"
#include "sluice/ledger/ledger.hpp"
#include "sluice/sluice_trace.h"

extern "C" {
int sluice_c99_write_log(const char* path, int leave_out_the_wait);
int sluice_c99_call_all_with(SluiceTraceLog* log, uint32_t none);
size_t sluice_c99_memory_size(void);
}

namespace sluice::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

/// Ids of the findings of at least Warning.
std::vector<std::string> findingsOf(const std::string& path) {
    ledger::Ledger ledger;
    const auto summary = ledger::readLog(path, sinkInto(ledger));
    EXPECT_TRUE(summary.ok());
    ledger.finish(summary.value().end);
    std::vector<std::string> ids;
    for (const ledger::Finding& finding : ledger.findings()) {
        const ledger::FindingInfo& info = ledger::findingInfo(finding.kind);
        if (info.severity != ledger::Severity::Info) {
            ids.emplace_back(info.id);
        }
    }
    return ids;
}

TEST(SluiceTrace, AC99EngineWithItsWaitsIsClean) {
    const TemporaryFile file;
    ASSERT_EQ(sluice_c99_write_log(file.path().c_str(), 0), 0);
    EXPECT_THAT(findingsOf(file.path()), ElementsAre());
    EXPECT_EQ(told(file.bytes()).back(), "end: closed");
}

TEST(SluiceTrace, AC99EngineWithoutItsWaitRaces) {
    const TemporaryFile file;
    ASSERT_EQ(sluice_c99_write_log(file.path().c_str(), 1), 0);
    // Without the wait, nothing orders OpenGL's last use before the thread's destruction either.
    EXPECT_THAT(findingsOf(file.path()),
                UnorderedElementsAre("race-read-after-write", "use-after-destroy", "use-after-destroy"));
}

TEST(SluiceTrace, NothingInIsNothingOut) {
    EXPECT_EQ(sluice_c99_call_all_with(nullptr, SLUICE_TRACE_NONE), 0);
    EXPECT_EQ(sluice_c99_call_all_with(nullptr, 0), 0);
    const TemporaryFile file;
    SluiceTraceLog* log = sluice_trace_open(file.path().c_str(), nullptr, 0);
    ASSERT_NE(log, nullptr);
    EXPECT_EQ(sluice_c99_call_all_with(log, SLUICE_TRACE_NONE), 0);
    EXPECT_EQ(sluice_trace_close(log), 0);
    EXPECT_THAT(told(file.bytes()), ElementsAre("end: closed")) << "ids that stand for nothing write nothing";
}

TEST(SluiceTrace, OpeningSaysWhyItFailed) {
    std::array<char, 200> why{};
    EXPECT_EQ(sluice_trace_open("/no/such/folder/a.log", why.data(), why.size()), nullptr);
    EXPECT_THAT(why.data(), HasSubstr("/no/such/folder/a.log': cannot create it: No such file"));
    std::array<char, 8> little{};
    EXPECT_EQ(sluice_trace_open("/no/such/folder/a.log", little.data(), little.size()), nullptr);
    EXPECT_STREQ(little.data(), "ledger ") << "cut, and ended";
    EXPECT_EQ(sluice_trace_open(nullptr, why.data(), why.size()), nullptr);
    EXPECT_THAT(why.data(), HasSubstr("the path is NULL"));
    EXPECT_EQ(sluice_trace_open(nullptr, nullptr, 10), nullptr);
}

TEST(SluiceTrace, ClosingSaysThatTheMarkDidNotFit) {
    const TemporaryFile file;
    SluiceTraceLog* log = sluice_trace_open(file.path().c_str(), nullptr, 0);
    ASSERT_NE(log, nullptr);
    const FullDisk disk(16);  // the header alone
    EXPECT_EQ(sluice_trace_status(log, nullptr, 0), 0);
    EXPECT_EQ(sluice_trace_close(log), -1);
}

TEST(SluiceTrace, ActorsAreAsManyAsALogCanHold) {
    const TemporaryFile file;
    SluiceTraceLog* log = sluice_trace_open(file.path().c_str(), nullptr, 0);
    for (uint32_t i = 0; i < 1024; ++i) {
        ASSERT_EQ(sluice_trace_actor(log, SLUICE_TRACE_HOST_THREAD, nullptr), i);
    }
    EXPECT_EQ(sluice_trace_actor(log, SLUICE_TRACE_HOST_THREAD, "one too many"), SLUICE_TRACE_NONE);
    EXPECT_EQ(sluice_trace_actor(log, SLUICE_TRACE_HOST_THREAD, "still"), SLUICE_TRACE_NONE);
    EXPECT_EQ(sluice_trace_close(log), 0);
}

TEST(SluiceTrace, FieldsArriveWhereTheLedgerReadsThem) {
    const TemporaryFile file;
    SluiceTraceLog* log = sluice_trace_open(file.path().c_str(), nullptr, 0);
    const uint32_t gl = sluice_trace_actor(log, SLUICE_TRACE_GL_CONTEXT, "gl");
    const uint32_t sync = sluice_trace_sync(log, SLUICE_TRACE_BINARY, "s", 3, SLUICE_TRACE_LISTED_ONLY | 0xF0U);
    const uint32_t image = sluice_trace_resource(log, "i", 5, gl);
    sluice_trace_release(log, gl, image, SLUICE_TRACE_NONE, 2, 7);
    sluice_trace_names(log, gl, image, 7);
    sluice_trace_wait_end(log, gl, sync, 9, 1, 1);
    sluice_trace_witness(log, gl, image, 4, SLUICE_TRACE_STALE);
    sluice_trace_destroy_resource(log, gl, image);
    EXPECT_EQ(sluice_trace_close(log), 0);
    auto lines = told(file.bytes());
    for (std::string& line : lines) {  // times differ from run to run
        for (int word = 0; word < 2 && line.front() >= '0' && line.front() <= '9'; ++word) {
            line.resize(line.rfind(' '));
        }
    }
    const std::uint64_t layouts = (std::uint64_t{7} << 32U) | 2U;
    EXPECT_THAT(lines, ElementsAre("actor 0 GL context gl", "sync 0 binary s 3 1", "resource 0 i 5 0",
                                   fmt::format("0 release 0 0 {} 65535 0", layouts), "1 names 0 0 7 0 0",
                                   "2 wait 0 0 9 0 256", "3 witness 0 0 4 1 0", "4 destroy 0 0 0 1 0", "end: closed"));
    EXPECT_EQ(sluice_c99_memory_size(), sizeof(ledger::MemoryFacts));
}

}  // namespace
}  // namespace sluice::test
