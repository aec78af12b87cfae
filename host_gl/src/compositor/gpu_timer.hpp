// SPDX-License-Identifier: MIT
// GL passes on the trace's clock.
#pragma once

#include <cstdint>
#include <deque>

#include "sluice/trace.hpp"

namespace sluice::host {

/// Places a pair of GL timestamps around a pass and, once both have arrived, records it as SLUICE_TRACE_PASS on
/// SLUICE_TRACK_HOST_GL. Never waits for the GPU. Does nothing without a Trace or without GL_ARB_timer_query. Freed
/// with the GL context current.
class GpuTimer {
  public:
    explicit GpuTimer(Trace* trace);
    GpuTimer(const GpuTimer&) = delete;
    GpuTimer& operator=(const GpuTimer&) = delete;
    ~GpuTimer();

    /// `name` must be a string literal; `bytes` is the pass's compulsory traffic.
    void begin(const char* name, std::uint64_t frame, std::uint64_t bytes);
    void end();
    /// Records what has arrived.
    void collect();

  private:
    struct Span {
        std::uint32_t first, last;
        const char* name;
        std::uint64_t frame, bytes;
    };
    Trace* trace_ = nullptr;
    std::int64_t to_monotonic_ = 0;  ///< nanoseconds to add to a GL timestamp
    bool open_ = false;
    std::deque<Span> pending_;
};

}  // namespace sluice::host
