// SPDX-License-Identifier: MIT
// `sluice stress`: its part of the command line.
#pragma once

#include <functional>

#include "stress/options.hpp"

namespace CLI {
class App;
}

namespace sluice::cli {

/// Adds the command to `app`; when it was given, `run` becomes what runs it. `options` must outlive both.
void addStressCommand(CLI::App& app, stress::Options& options, std::function<int()>& run);

/// Runs every combination that is meant, prints a table or JSON on stdout, and returns an exit code.
[[nodiscard]] int stress(const stress::Options& options);

}  // namespace sluice::cli
