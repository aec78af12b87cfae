// SPDX-License-Identifier: MIT
// Signal and wait events as every backend records them.
#pragma once

#include <cstdint>

#include "sluice/plugin.h"
#include "sluice/trace.hpp"

namespace sluice::host {

/// The time now, or 0 without looking at the clock when nobody listens.
[[nodiscard]] inline std::uint64_t traceClock(const Trace* trace, const void* feed = nullptr) {
    return trace != nullptr || feed != nullptr ? monotonicNanoseconds() : 0;
}

/// Frame of a timeline value; docs/protocol.md.
[[nodiscard]] constexpr std::uint64_t frameOfValue(SluiceDirection direction, std::uint64_t value) {
    return direction == SLUICE_HOST_TO_RENDERER ? (value + 1) / 2 : value;
}

/// Records an event that began at `begin` and ends now. `name` may be any text that lives during the call.
inline void traceStep(Trace* trace, SluiceTraceKind kind, SluiceTrack track, SluiceDirection direction,
                      std::uint64_t value, std::uint64_t begin, const char* name) {
    if (trace == nullptr) {
        return;
    }
    SluiceTraceEvent event{};
    event.struct_size = sizeof(event);
    event.kind = kind;
    event.track = track;
    event.direction = direction;
    event.begin_ns = begin;
    event.duration_ns = monotonicNanoseconds() - begin;
    event.frame = frameOfValue(direction, value);
    event.value = value;
    event.name = name;
    trace->record(event);
}

}  // namespace sluice::host
