// SPDX-License-Identifier: MIT
// The ring under load: nothing torn, nothing lost below capacity, every drop counted.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "sluice/trace.hpp"

namespace {

using sluice::Trace;
using sluice::TraceRecord;

constexpr std::uint64_t kThreads = 8;

SluiceTraceEvent event(SluiceTraceKind kind = SLUICE_TRACE_MARK, const char* name = "event") {
    SluiceTraceEvent e{};
    e.struct_size = sizeof e;
    e.kind = kind;
    e.name = name;
    return e;
}

/// Every field is derived from one number, so that a record mixed from two shows.
void recordNumber(Trace& trace, std::uint64_t number) {
    const std::string name = "n" + std::to_string(number);
    SluiceTraceEvent e = event(static_cast<SluiceTraceKind>(number % SLUICE_TRACE_KIND_COUNT), name.c_str());
    e.track = static_cast<std::uint32_t>(number % SLUICE_TRACK_COUNT);
    e.direction = static_cast<std::uint32_t>(number % 2);
    e.begin_ns = number * 3;
    e.duration_ns = number * 5;
    e.frame = number * 7;
    e.value = number;
    e.bytes = ~number;
    trace.record(e);
}

bool isWhole(const TraceRecord& record) {
    const std::uint64_t n = record.value;
    return record.kind == static_cast<SluiceTraceKind>(n % SLUICE_TRACE_KIND_COUNT) &&
           record.track == static_cast<SluiceTrack>(n % SLUICE_TRACK_COUNT) &&
           record.direction == static_cast<SluiceDirection>(n % 2) && record.begin_ns == n * 3 &&
           record.duration_ns == n * 5 && record.frame == n * 7 && record.bytes == ~n &&
           std::string(record.name.data()) == "n" + std::to_string(n);
}

template <typename Work>
void onEveryThread(Work&& work) {
    std::atomic<std::uint64_t> waiting{kThreads};
    std::vector<std::jthread> threads;
    for (std::uint64_t thread = 0; thread < kThreads; ++thread) {
        threads.emplace_back([&, thread] {
            --waiting;
            while (waiting.load() != 0) {
                std::this_thread::yield();
            }
            work(thread);
        });
    }
}

std::set<std::uint64_t> valuesOf(const std::vector<TraceRecord>& records) {
    std::set<std::uint64_t> values;
    for (const TraceRecord& record : records) {
        EXPECT_TRUE(isWhole(record)) << "torn record " << record.value << " '" << record.name.data() << "'";
        EXPECT_TRUE(values.insert(record.value).second) << record.value << " twice";
    }
    return values;
}

TEST(TraceRing, EightThreadsLoseNothingBelowCapacity) {
    constexpr std::uint64_t kEach = 4096;
    Trace trace(kThreads * kEach);
    onEveryThread([&](std::uint64_t thread) {
        for (std::uint64_t i = 0; i < kEach; ++i) {
            recordNumber(trace, thread * kEach + i);
        }
    });
    EXPECT_EQ(trace.dropped(), 0U);
    const auto values = valuesOf(trace.drain());
    EXPECT_EQ(values.size(), kThreads * kEach);
    EXPECT_EQ(*values.rbegin(), kThreads * kEach - 1);
}

TEST(TraceRing, EightThreadsAboveCapacityDropExactlyTheRest) {
    constexpr std::uint64_t kEach = 3000;
    constexpr std::uint64_t kCapacity = 4096;
    Trace trace(kCapacity);
    onEveryThread([&](std::uint64_t thread) {
        for (std::uint64_t i = 0; i < kEach; ++i) {
            recordNumber(trace, thread * kEach + i);
        }
    });
    EXPECT_EQ(trace.dropped(), kThreads * kEach - kCapacity);
    EXPECT_EQ(valuesOf(trace.drain()).size(), kCapacity);
}

TEST(TraceRing, DrainingWhileEightThreadsRecordLosesOnlyWhatIsCounted) {
    constexpr std::uint64_t kEach = 4000;
    Trace trace(1024);
    std::vector<TraceRecord> all;
    std::atomic<bool> done{false};
    std::jthread reader([&] {
        const auto collect = [&] {
            const auto records = trace.drain();
            all.insert(all.end(), records.begin(), records.end());
        };
        while (!done.load()) {
            collect();
            std::this_thread::yield();
        }
        collect();
    });
    onEveryThread([&](std::uint64_t thread) {
        for (std::uint64_t i = 0; i < kEach; ++i) {
            recordNumber(trace, thread * kEach + i);
        }
    });
    done = true;
    reader.join();
    EXPECT_EQ(valuesOf(all).size() + trace.dropped(), kThreads * kEach);
    EXPECT_GE(all.size(), 1024U);
}

TEST(TraceRing, DropsTheNewestWhenFullAndRunsAgainAfterADrain) {
    Trace trace(4);
    for (std::uint64_t lap = 0; lap < 5; ++lap) {
        for (std::uint64_t i = 0; i < 6; ++i) {
            recordNumber(trace, lap * 10 + i);
        }
        EXPECT_EQ(valuesOf(trace.drain()),
                  (std::set<std::uint64_t>{lap * 10, lap * 10 + 1, lap * 10 + 2, lap * 10 + 3}));
        EXPECT_EQ(trace.dropped(), 2 * (lap + 1));
    }
    EXPECT_TRUE(trace.drain().empty());
}

TEST(TraceRing, CapacityIsRoundedUpToAPowerOfTwo) {
    for (const auto& [asked, kept] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 1}, {3, 4}, {5, 8}, {8, 8}}) {
        Trace trace(asked);
        for (std::uint64_t i = 0; i < 20; ++i) {
            recordNumber(trace, i);
        }
        EXPECT_EQ(trace.drain().size(), kept) << "asked for " << asked;
        EXPECT_EQ(trace.dropped(), 20 - kept);
    }
}

TEST(TraceRing, DrainsOldestFirstByBeginTime) {
    Trace trace(16);
    for (const std::uint64_t number : {5U, 1U, 9U, 3U}) {
        recordNumber(trace, number);
    }
    const auto records = trace.drain();
    ASSERT_EQ(records.size(), 4U);
    EXPECT_TRUE(std::ranges::is_sorted(records, {}, &TraceRecord::begin_ns));
}

TEST(TraceRing, CopiesAndTruncatesTheName) {
    Trace trace(4);
    std::string name(100, 'x');
    trace.record(event(SLUICE_TRACE_MARK, name.c_str()));
    name.assign(100, 'y');
    SluiceTraceEvent nameless = event();
    nameless.name = nullptr;
    trace.record(nameless);
    const auto records = trace.drain();
    ASSERT_EQ(records.size(), 2U);
    EXPECT_EQ(std::string(records[0].name.data()), std::string(31, 'x'));
    EXPECT_EQ(std::string(records[1].name.data()), "");
}

TEST(TraceRing, TakesLongerEventsOfANewerPluginAndNoneShorterThanOneDotZero) {
    Trace trace(4);
    SluiceTraceEvent one = event(SLUICE_TRACE_SIGNAL, "newer");
    one.value = 9;
    one.struct_size = sizeof(SluiceTraceEvent) + 16;
    trace.record(one);
    one.struct_size = sizeof(SluiceTraceEvent) - 1;
    trace.record(one);
    const auto records = trace.drain();
    ASSERT_EQ(records.size(), 1U);
    EXPECT_EQ(records[0].value, 9U);
    EXPECT_EQ(std::string(records[0].name.data()), "newer");
    EXPECT_EQ(trace.dropped(), 1U);
}

TEST(TraceRing, CountsEventsItCannotUnderstandAsDropped) {
    Trace trace(8);
    SluiceTraceEvent empty{};
    trace.record(empty);
    SluiceTraceEvent kind = event();
    kind.kind = SLUICE_TRACE_KIND_COUNT;
    trace.record(kind);
    SluiceTraceEvent track = event();
    track.track = SLUICE_TRACK_COUNT;
    trace.record(track);
    SluiceTraceEvent direction = event(SLUICE_TRACE_WAIT);
    direction.direction = 3;
    trace.record(direction);
    EXPECT_EQ(trace.dropped(), 4U);
    EXPECT_TRUE(trace.drain().empty());
}

TEST(TraceTotals, SumByKind) {
    Trace trace(32);
    for (std::uint64_t i = 0; i < 3; ++i) {
        SluiceTraceEvent copy = event(SLUICE_TRACE_CPU_COPY);
        copy.bytes = 100 + i;
        copy.duration_ns = 10;
        trace.record(copy);
    }
    trace.record(event(SLUICE_TRACE_PASS));
    const auto sum = sluice::totals(trace.drain());
    EXPECT_EQ(sum.count[SLUICE_TRACE_CPU_COPY], 3U);
    EXPECT_EQ(sum.bytes[SLUICE_TRACE_CPU_COPY], 303U);
    EXPECT_EQ(sum.nanoseconds[SLUICE_TRACE_CPU_COPY], 30U);
    EXPECT_EQ(sum.count[SLUICE_TRACE_PASS], 1U);
    EXPECT_EQ(sum.count[SLUICE_TRACE_WAIT], 0U);
}

TEST(MonotonicNanoseconds, NeverGoesBack) {
    std::uint64_t last = sluice::monotonicNanoseconds();
    for (int i = 0; i < 1000; ++i) {
        const std::uint64_t now = sluice::monotonicNanoseconds();
        ASSERT_GE(now, last);
        last = now;
    }
}

}  // namespace
