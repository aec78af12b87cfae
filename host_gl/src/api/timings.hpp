// SPDX-License-Identifier: MIT
// Where the time of an engine's frames goes: sums over trace events.
#pragma once

#include "sluice/trace.hpp"

namespace sluice::host {

/// Seconds, since the beginning.
struct Timings {
    double capture = 0, hand_over = 0, fluid = 0, simulation = 0, composite = 0;
};

/// Adds one event to what it is part of. Hand-over is what the engine's thread spends in signals, waits and the
/// submission.
void addTo(Timings& timings, const TraceRecord& event);

}  // namespace sluice::host
