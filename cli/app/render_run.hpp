// SPDX-License-Identifier: MIT
// A render from its first frame to its last, and what is kept of it for the summary.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/live_run.hpp"
#include "app/options.hpp"
#include "app/render_inputs.hpp"
#include "app/render_session.hpp"
#include "report/statistics.hpp"
#include "report/summary.hpp"
#include "sluice/trace.hpp"

namespace sluice::cli {

/// A run in progress.
struct Run {
    const RenderOptions& options;
    RenderInputs inputs;
    RenderSession session;
    RunSummary summary;
    PassStatistics passes;
    std::vector<TraceRecord> records;  ///< kept only when a trace file is wanted
    std::filesystem::path particle_file;
    std::optional<LiveRun> live;  ///< in the place of particle files
    std::string last_problem;
    std::uint64_t submitted = 0;  ///< FluidHost::frame() after the last frame
};

/// Starts the renderer, draws and writes every frame. The exit code of the first thing that ended the run, or 0.
/// Running out of memory ends the run, not the files that are already written.
[[nodiscard]] int renderAll(Run& run);

/// What to say when there is not enough memory for frames of that size.
[[nodiscard]] Error noMemory(scene::Size size, bool layers);

}  // namespace sluice::cli
