// SPDX-License-Identifier: MIT
#include "api/timings.hpp"

#include <string_view>

namespace sluice::host {

void addTo(Timings& timings, const TraceRecord& event) {
    const double seconds = static_cast<double>(event.duration_ns) * 1e-9;
    const std::string_view name(event.name.data());
    const bool of_thread =
        event.track == SLUICE_TRACK_HOST_CPU &&
        (event.kind == SLUICE_TRACE_SIGNAL || event.kind == SLUICE_TRACE_WAIT || event.kind == SLUICE_TRACE_SUBMIT);
    if (of_thread) {
        timings.hand_over += seconds;
    } else if (event.kind != SLUICE_TRACE_PASS) {
        return;
    } else if (event.track == SLUICE_TRACK_RENDERER_QUEUE) {
        timings.fluid += seconds;
    } else if (event.track == SLUICE_TRACK_SIMULATION) {
        timings.simulation += seconds;
    } else if (name == "capture") {
        timings.capture += seconds;
    } else if (name == "composite") {
        timings.composite += seconds;
    }
}

}  // namespace sluice::host
