// SPDX-License-Identifier: MIT
// `sluice simulate`: its part of the command line.
#pragma once

#include <functional>

#include "app/options.hpp"

namespace CLI {
class App;
}

namespace sluice::cli {

/// Adds the command to `app`; when it was given, `run` becomes what runs it. All arguments must outlive both.
void addSimulateCommand(CLI::App& app, SimulateOptions& options, int& verbosity, std::function<int()>& run);

}  // namespace sluice::cli
