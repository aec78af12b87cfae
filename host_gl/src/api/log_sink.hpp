// SPDX-License-Identifier: MIT
// Where lines for the engine's programmer go.
#pragma once

#include <functional>
#include <string_view>

#include "sluice/plugin.h"
#include "sluice/sluice.h"

namespace sluice::host {

using LogSink = std::function<void(SluiceLogLevel, std::string_view)>;

/// The engine's own callback; else warnings and errors, a line each, on stderr.
[[nodiscard]] LogSink logSink(const SluiceOptions& options);

}  // namespace sluice::host
