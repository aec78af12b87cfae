// SPDX-License-Identifier: MIT
// The summary of a render, as a table and as JSON. docs/cli.md documents the JSON.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "report/live_report.hpp"
#include "report/statistics.hpp"
#include "sluice/ledger/finding.hpp"
#include "sluice/ledger/live.hpp"
#include "sluice/plugin.h"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// What the ledger saw.
struct LedgerSummary {
    std::uint64_t events = 0, memory_bytes = 0, dropped = 0;
    std::vector<ledger::Finding> findings;
    std::optional<ledger::Unchecked> unchecked;
};

struct RunSummary {
    std::string scene;
    scene::FrameRange frames;
    scene::Size size;
    std::uint64_t particles = 0;  ///< of the last frame
    float radius = 0.0F;
    std::uint64_t frames_written = 0, frames_with_fluid = 0;
    bool has_renderer = false;  ///< the next four are meaningful
    std::string plugin, renderer;
    SluiceRendererInfo info{};
    std::string timeline_reason;
    std::vector<PassRow> passes;
    HostRow logic{"host animation", {}}, draw{"host draw", {}}, submit{"host capture and submit", {}},
        composite{"host wait and composite", {}}, wait{"of which waiting", {}}, write{"output files", {}};
    CopyBytes copies;
    std::uint64_t uploaded_bytes = 0, trace_dropped = 0;
    std::uint32_t validation_messages = 0;
    std::vector<std::string> files, problems;
    std::optional<LedgerSummary> ledger;  ///< empty: it was off
    std::optional<LiveSummary> live;      ///< empty: the particles came from files
    int exit_code = 0;
};

[[nodiscard]] std::string summaryText(const RunSummary& summary);
[[nodiscard]] nlohmann::ordered_json summaryJson(const RunSummary& summary);

}  // namespace sluice::cli
