// SPDX-License-Identifier: MIT
#include "app/live_run.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sluice::cli {

Status LiveRun::begin(host::FluidHost* host, std::int64_t frame) {
    if (host == nullptr) {
        return {};
    }
    const std::int64_t ahead = frame + std::int64_t{fluid_.settings.frames_in_flight} - 1;
    const auto wanted = static_cast<std::uint64_t>(std::min(ahead, frames_.last));
    while (asked_ < wanted) {
        if (Status status = host->simulate(asked_ + 1, asked_ == 0 ? 0.0 : fluid_.frame_s); !status) {
            return status;
        }
        ++asked_;
    }
    return {};
}

std::optional<std::string> LiveRun::end(host::FluidHost& host) {
    const Result<SluiceSimulationStats> stats = host.simulationStats();
    if (!stats) {
        return std::nullopt;  // a renderer that is gone is told of elsewhere
    }
    summary_ = LiveSummary{stats.value(), fluid_.settings.frames_in_flight};
    if (stats.value().failed == 0 || told_) {
        return std::nullopt;
    }
    told_ = true;
    return fmt::format("the fluid stands still from frame {} on: {}", stats.value().failed, stats.value().message);
}

std::string sayLive(const std::string& scene, const LiveFluid& fluid) {
    return fmt::format("{}: names no particles, so its simulation runs live: {} particles{}, {} frame{} in flight",
                       scene, fluid.count(),
                       fluid.emitters.empty() ? "" : fmt::format(", {} at most", fluid.settings.max_particles),
                       fluid.settings.frames_in_flight, fluid.settings.frames_in_flight == 1 ? "" : "s");
}

}  // namespace sluice::cli
