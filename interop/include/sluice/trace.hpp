// SPDX-License-Identifier: MIT
// The event trace: a lock-free ring that any thread may write, and its Chrome trace JSON (opens in Perfetto).
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice {

/// CLOCK_MONOTONIC in nanoseconds: the one clock of every event.
[[nodiscard]] std::uint64_t monotonicNanoseconds();

/// An event as it is kept: the ABI event with its name copied.
struct TraceRecord {
    SluiceTraceKind kind;
    SluiceTrack track;
    SluiceDirection direction;
    std::uint64_t begin_ns, duration_ns, frame, value, bytes;
    std::array<char, 32> name;
};

/// Multi-producer ring of fixed capacity; when full it drops the newest events and counts them.
/// record() is wait-free but for one fetch_add and may be called from any thread; drain() from one thread at a time.
class Trace {
  public:
    /// capacity is rounded up to a power of two.
    explicit Trace(std::size_t capacity);
    Trace(const Trace&) = delete;
    Trace& operator=(const Trace&) = delete;
    ~Trace();

    void record(const SluiceTraceEvent& event);
    /// Moves everything recorded so far out of the ring, oldest first by begin time.
    [[nodiscard]] std::vector<TraceRecord> drain();
    [[nodiscard]] std::uint64_t dropped() const;

  private:
    struct Ring;
    std::unique_ptr<Ring> ring_;
};

/// Totals by kind, for summaries and for proving that the frame loop copied nothing.
struct TraceTotals {
    std::array<std::uint64_t, SLUICE_TRACE_KIND_COUNT> count{};
    std::array<std::uint64_t, SLUICE_TRACE_KIND_COUNT> bytes{};
    std::array<std::uint64_t, SLUICE_TRACE_KIND_COUNT> nanoseconds{};
};
[[nodiscard]] TraceTotals totals(const std::vector<TraceRecord>& records);

/// Chrome trace event format: one named thread per track, "X" events with args {frame, value, bytes, direction}, flow
/// arrows
/// ("s"/"f") from each SIGNAL to the WAITs of the same direction and value. Times are microseconds from the first
/// event.
void writeChromeTrace(std::ostream& out, const std::vector<TraceRecord>& records, std::uint64_t dropped);
/// The same to a file, written whole or not at all (temporary file and rename).
[[nodiscard]] Status writeChromeTraceFile(const std::string& path, const std::vector<TraceRecord>& records,
                                          std::uint64_t dropped);

}  // namespace sluice
