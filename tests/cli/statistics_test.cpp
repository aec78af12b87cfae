// SPDX-License-Identifier: MIT
#include "report/statistics.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "report/progress.hpp"
#include "report/table.hpp"

namespace sluice::cli {
namespace {

TEST(Median, IsTheMiddleOrTheMeanOfTheTwoMiddleValues) {
    EXPECT_EQ(median({}), 0.0);
    EXPECT_EQ(median({5.0}), 5.0);
    EXPECT_EQ(median({9.0, 1.0, 5.0}), 5.0);
    EXPECT_EQ(median({9.0, 1.0, 5.0, 7.0}), 6.0);
}

SluicePassStats pass(const char* name, std::uint64_t ns, std::uint64_t elements) {
    SluicePassStats stats{};
    std::strncpy(&stats.name[0], name, sizeof(stats.name) - 1);
    stats.nanoseconds = ns;
    stats.elements = elements;
    stats.bytes = 10;
    stats.dispatches = 1;
    return stats;
}

TEST(PassStatistics, SumsWithinAFrameAndTakesTheMedianOverFrames) {
    PassStatistics statistics;
    for (const std::uint64_t scale : {1U, 3U, 2U}) {
        SluiceFrameStats frame{};
        frame.pass_count = 3;
        frame.passes[0] = pass("splat", 1'000'000 * scale, 100);
        frame.passes[1] = pass("filter", 2'000'000 * scale, 50);
        frame.passes[2] = pass("filter", 3'000'000 * scale, 50);
        statistics.add(frame);
    }
    const std::vector<PassRow> rows = statistics.rows();
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].name, "splat");
    EXPECT_DOUBLE_EQ(rows[0].median_ms, 2.0);
    EXPECT_EQ(rows[1].name, "filter");
    EXPECT_EQ(rows[1].calls, 6U);
    EXPECT_EQ(rows[1].frames, 3U);
    EXPECT_DOUBLE_EQ(rows[1].median_ms, 10.0);
    EXPECT_DOUBLE_EQ(rows[1].min_ms, 5.0);
    EXPECT_DOUBLE_EQ(rows[1].max_ms, 15.0);
    EXPECT_EQ(rows[1].elements, 100U);
    EXPECT_EQ(rows[1].bytes, 20U);
    SluiceFrameStats more{};
    more.pass_count = 1;
    more.passes[0] = pass("splat", 1'000'000, 170);
    statistics.add(more);
    EXPECT_EQ(statistics.rows()[0].elements, 170U) << "a bound is of every frame";
}

TraceRecord copy(const char* name, std::uint64_t bytes) {
    TraceRecord record{};
    record.kind = SLUICE_TRACE_CPU_COPY;
    record.bytes = bytes;
    std::strncpy(record.name.data(), name, record.name.size() - 1);
    return record;
}

TEST(Copies, OnlyReadbacksAndUploadsAreExcused) {
    CopyBytes sum;
    TraceRecord signal = copy("read colour", 1000);
    signal.kind = SLUICE_TRACE_SIGNAL;
    addCopies(sum, {copy("read colour", 1), copy("particle upload", 2), copy("host colour", 4), signal});
    EXPECT_EQ(sum.readback, 1U);
    EXPECT_EQ(sum.upload, 2U);
    EXPECT_EQ(sum.shared_images, 4U);
}

TEST(Waits, AreThoseOfTheHostOnly) {
    TraceRecord host{};
    host.kind = SLUICE_TRACE_WAIT;
    host.track = SLUICE_TRACK_HOST_GL;
    host.duration_ns = 2'500'000;
    TraceRecord bridge = host;
    bridge.track = SLUICE_TRACK_BRIDGE;
    EXPECT_DOUBLE_EQ(waitMilliseconds({host, bridge}), 2.5);
}

TEST(Table, AlignsColumns) {
    EXPECT_EQ(formatTable({{"a", "b"}, {"long", "1"}, {"x", "22"}}, {1}), "a      b\n----  --\nlong   1\nx     22\n");
}

TEST(Table, CountsAndBytesReadWell) {
    EXPECT_EQ(formatCount(0), "0");
    EXPECT_EQ(formatCount(999), "999");
    EXPECT_EQ(formatCount(96161), "96,161");
    EXPECT_EQ(formatCount(1234567), "1,234,567");
    EXPECT_EQ(formatBytes(1023), "1023 B");
    EXPECT_EQ(formatBytes(1536), "1.5 KiB");
    EXPECT_EQ(formatBytes(5.0 * 1024 * 1024), "5.0 MiB");
}

TEST(ProgressLine, TellsTimePerFrameAndTimeLeft) {
    EXPECT_EQ(progressLine(6, 24, 3.0, "frame 7"),
              "[######------------------] 6/24 frames, 0.50 s each, 9 s left, frame 7");
    EXPECT_EQ(progressLine(0, 2, 0.0, "x"), "[------------------------] 0/2 frames, x");
}

}  // namespace
}  // namespace sluice::cli
