// SPDX-License-Identifier: MIT
// The commands about ordering: diagnose, explain-finding.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "sluice/scene/scene.hpp"

namespace CLI {
class App;
}

namespace sluice::cli {

struct DiagnoseOptions {
    std::string log;
    std::string trace, html;  ///< files to write; empty: none
    std::optional<std::uint32_t> frame;
    std::optional<scene::FrameRange> frames;  ///< of the page
    bool json = false, all = false, quiet = false;
};
struct ExplainFindingOptions {
    std::string id;  ///< empty: the list
    bool json = false;
};
struct LedgerCommands {
    DiagnoseOptions diagnose;
    ExplainFindingOptions explain_finding;
};

/// Adds the commands to `app`; the chosen one puts its work into `run`.
void addLedgerCommands(CLI::App& app, LedgerCommands& commands, std::function<int()>& run);

[[nodiscard]] int diagnose(const DiagnoseOptions& options);
[[nodiscard]] int explainFinding(const ExplainFindingOptions& options);

}  // namespace sluice::cli
