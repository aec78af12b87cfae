// SPDX-License-Identifier: MIT
// Which values of the simulation are asked for in which frame of a render, and what came of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/live_fluid.hpp"
#include "report/live_report.hpp"
#include "sluice/host_gl/fluid_host.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// Frame k draws value k. With F frames in flight, frame k asks for value k + F - 1 before anything else, so that the
/// host's own work of the frame, and with F > 1 that of the frames before, runs beside the simulation.
class LiveRun {
  public:
    LiveRun(const LiveFluid& fluid, scene::FrameRange frames) : fluid_(fluid), frames_(frames) {}

    /// Before the host's work of `frame`. Nothing without a host.
    [[nodiscard]] Status begin(host::FluidHost* host, std::int64_t frame);
    /// After the frame. Why the fluid cannot flow on, once.
    [[nodiscard]] std::optional<std::string> end(host::FluidHost& host);
    [[nodiscard]] const std::optional<LiveSummary>& summary() const { return summary_; }

  private:
    const LiveFluid& fluid_;
    scene::FrameRange frames_;
    std::uint64_t asked_ = 0;
    bool told_ = false;
    std::optional<LiveSummary> summary_;
};

/// One line for the log: that the scene is simulated now, and not read.
[[nodiscard]] std::string sayLive(const std::string& scene, const LiveFluid& fluid);

}  // namespace sluice::cli
