// SPDX-License-Identifier: MIT
// The commands. Each prints its result on stdout, its troubles on stderr, and returns an exit code.
#pragma once

#include "app/exit_codes.hpp"
#include "app/options.hpp"

namespace sluice::cli {

[[nodiscard]] int render(const RenderOptions& options);
[[nodiscard]] int probe(const ProbeOptions& options);
[[nodiscard]] int explain(const ExplainOptions& options);
[[nodiscard]] int generate(const GenerateOptions& options);
[[nodiscard]] int simulate(const SimulateOptions& options);
[[nodiscard]] int convert(const ConvertOptions& options);

/// Parses the command line and runs the command. Never throws.
[[nodiscard]] int runCommandLine(int argc, const char* const* argv) noexcept;

}  // namespace sluice::cli
