// SPDX-License-Identifier: MIT
// Log lines on stderr.
#pragma once

#include <string_view>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::cli {

/// Warnings and errors by default; 1: information; 2: everything. quiet: errors only.
void startLog(int verbosity, bool quiet);
/// Any thread.
void log(SluiceLogLevel level, std::string_view message);
void logError(const Error& error);

}  // namespace sluice::cli
