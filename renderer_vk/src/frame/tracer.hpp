// SPDX-License-Identifier: MIT
// The renderer's events for the host's trace.
#pragma once

#include <cstdint>

#include "sluice/plugin.h"

namespace sluice::vk {

/// An event without its struct_size; name is a string literal.
struct TracedEvent {
    SluiceTraceKind kind = SLUICE_TRACE_MARK;
    SluiceTrack track = SLUICE_TRACK_RENDERER_CPU;
    const char* name = "";
    std::uint64_t begin_ns = 0, duration_ns = 0, frame = 0, value = 0, bytes = 0;
    SluiceDirection direction = SLUICE_HOST_TO_RENDERER;
};

/// Costs one comparison when the host does not trace. The services outlive it.
class Tracer {
  public:
    explicit Tracer(const SluiceHostServices& host) : host_(&host) {}
    [[nodiscard]] bool on() const { return host_->trace != nullptr; }
    /// CLOCK_MONOTONIC, or 0 when off, so that no clock is read in vain.
    [[nodiscard]] std::uint64_t now() const;
    void emit(const TracedEvent& event) const;

  private:
    const SluiceHostServices* host_;
};

}  // namespace sluice::vk
