// SPDX-License-Identifier: MIT
#include "report/live_report.hpp"

#include <fmt/format.h>

namespace sluice::cli {
namespace {

std::string plural(std::uint64_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

std::string liveText(const LiveSummary& live) {
    const SluiceSimulationStats& s = live.stats;
    return fmt::format(
        "simulated {} in {} ({} taken again), {:.1f} ms, on {}; {} in flight: the picture is {} behind what "
        "the host asked for last\n",
        plural(s.reached, "frame"), plural(s.steps, "step"), s.steps_taken_again, static_cast<double>(s.busy_ns) * 1e-6,
        s.own_queue != 0 ? "a queue of its own" : "the queue of the frames", plural(live.frames_in_flight, "frame"),
        plural(live.frames_in_flight - 1, "frame"));
}

nlohmann::ordered_json liveJson(const LiveSummary& live) {
    const SluiceSimulationStats& s = live.stats;
    return {{"frames", s.reached},
            {"steps", s.steps},
            {"steps_taken_again", s.steps_taken_again},
            {"shortest_step_s", s.shortest_step},
            {"fastest", s.fastest},
            {"busy_ms", static_cast<double>(s.busy_ns) * 1e-6},
            {"own_queue", s.own_queue != 0},
            {"frames_in_flight", live.frames_in_flight},
            {"latency_frames", live.frames_in_flight - 1},
            {"stands_still_from", s.failed}};
}

}  // namespace sluice::cli
