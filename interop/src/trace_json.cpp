// SPDX-License-Identifier: MIT
// Chrome trace JSON (the "Trace Event Format" document, 2016), as Perfetto and chrome://tracing load it.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string_view>
#include <utility>

#include "sluice/trace.hpp"

namespace sluice {

namespace {

constexpr int kProcess = 1;

constexpr std::array<std::string_view, SLUICE_TRACE_KIND_COUNT> kKindNames{"signal", "wait", "acquire",  "release",
                                                                           "submit", "pass", "cpu copy", "mark"};
constexpr std::array<std::string_view, SLUICE_TRACK_COUNT> kTrackNames{"host CPU",     "host GL",        "bridge",
                                                                       "renderer CPU", "renderer queue", "simulation"};
constexpr std::array<std::string_view, 3> kDirectionNames{"host to renderer", "renderer to host",
                                                          "simulation to renderer"};

template <std::size_t Size, typename Enum>
std::string_view nameOf(const std::array<std::string_view, Size>& names, Enum value) {
    const auto index = static_cast<std::size_t>(value);
    return index < Size ? names[index] : "unknown";
}

/// Threads count from 1: some viewers treat thread 0 as the idle thread.
int threadOf(SluiceTrack track) {
    return static_cast<int>(track) + 1;
}

/// A JSON string; bytes that are not UTF-8 (a name cut inside a character) become U+FFFD.
std::string quoted(std::string_view text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Microseconds with all nanoseconds kept: a double would round long traces.
std::string microseconds(std::uint64_t ns) {
    return fmt::format("{}.{:03}", ns / 1000, ns % 1000);
}

std::uint64_t endOf(const TraceRecord& record) {
    return record.begin_ns + record.duration_ns;
}

bool isTimeline(const TraceRecord& record) {
    return record.kind == SLUICE_TRACE_SIGNAL || record.kind == SLUICE_TRACE_WAIT;
}

std::string slice(const TraceRecord& record, std::uint64_t origin) {
    const std::string_view kind = nameOf(kKindNames, record.kind);
    std::string_view name(record.name.data(), strnlen(record.name.data(), record.name.size()));
    name = name.empty() ? kind : name;
    std::string args = fmt::format(R"("frame":{},"value":{},"bytes":{})", record.frame, record.value, record.bytes);
    if (isTimeline(record)) {
        args += fmt::format(R"(,"direction":"{}")", nameOf(kDirectionNames, record.direction));
    }
    return fmt::format(R"({{"ph":"X","pid":{},"tid":{},"ts":{},"dur":{},"name":{},"cat":"{}","args":{{{}}}}})",
                       kProcess, threadOf(record.track), microseconds(record.begin_ns - origin),
                       microseconds(record.duration_ns), quoted(name), kind, args);
}

/// One end of an arrow. "bp":"e" binds it to the slice that encloses it rather than to the next one.
std::string arrowEnd(char phase, std::uint64_t id, const TraceRecord& record, std::uint64_t at_ns,
                     std::uint64_t origin) {
    return fmt::format(R"({{"ph":"{}","bp":"e","pid":{},"tid":{},"ts":{},"id":{},"name":"{} {}","cat":"timeline"}})",
                       phase, kProcess, threadOf(record.track), microseconds(at_ns - origin), id,
                       nameOf(kDirectionNames, record.direction), record.value);
}

std::vector<std::string> threadNames() {
    std::vector<std::string> events{
        fmt::format(R"({{"ph":"M","pid":{},"name":"process_name","args":{{"name":"sluice"}}}})", kProcess)};
    for (int track = 0; track < SLUICE_TRACK_COUNT; ++track) {
        const int thread = threadOf(static_cast<SluiceTrack>(track));
        events.push_back(fmt::format(R"({{"ph":"M","pid":{},"tid":{},"name":"thread_name","args":{{"name":"{}"}}}})",
                                     kProcess, thread, nameOf(kTrackNames, track)));
        events.push_back(
            fmt::format(R"({{"ph":"M","pid":{},"tid":{},"name":"thread_sort_index","args":{{"sort_index":{}}}}})",
                        kProcess, thread, thread));
    }
    return events;
}

/// An arrow from each signal to each wait of the same direction and value; none where either is missing.
std::vector<std::string> arrows(const std::vector<TraceRecord>& records, std::uint64_t origin) {
    std::multimap<std::pair<SluiceDirection, std::uint64_t>, const TraceRecord*> signals;
    for (const TraceRecord& record : records) {
        if (record.kind == SLUICE_TRACE_SIGNAL) {
            signals.emplace(std::pair(record.direction, record.value), &record);
        }
    }
    std::vector<std::string> events;
    std::uint64_t id = 0;
    for (const TraceRecord& wait : records) {
        if (wait.kind != SLUICE_TRACE_WAIT) {
            continue;
        }
        const auto [first, last] = signals.equal_range(std::pair(wait.direction, wait.value));
        for (auto it = first; it != last; ++it) {
            const TraceRecord& signal = *it->second;
            // The arrow must not point back in time where the wait began before the signal and blocked for it; it stays
            // inside the wait's slice, so that a wait that ended before its signal shows as what it is.
            const std::uint64_t arrival = std::clamp(signal.begin_ns, wait.begin_ns, endOf(wait));
            ++id;
            events.push_back(arrowEnd('s', id, signal, signal.begin_ns, origin));
            events.push_back(arrowEnd('f', id, wait, arrival, origin));
        }
    }
    return events;
}

}  // namespace

void writeChromeTrace(std::ostream& out, const std::vector<TraceRecord>& records, std::uint64_t dropped) {
    std::uint64_t origin = records.empty() ? 0 : records.front().begin_ns;
    for (const TraceRecord& record : records) {
        origin = std::min(origin, record.begin_ns);
    }
    out << fmt::format(
               R"({{"displayTimeUnit":"ms","otherData":{{"clock":"CLOCK_MONOTONIC","origin_ns":"{}","dropped":{}}},)",
               origin, dropped)
        << "\n\"traceEvents\":[\n";
    std::string_view separator;
    const auto put = [&](const std::string& event) {
        out << separator << event;
        separator = ",\n";
    };
    std::ranges::for_each(threadNames(), put);
    for (const TraceRecord& record : records) {
        put(slice(record, origin));
    }
    std::ranges::for_each(arrows(records, origin), put);
    out << "\n]}\n";
}

}  // namespace sluice
