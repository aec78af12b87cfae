// SPDX-License-Identifier: MIT
// Failures as a renderer tells them.
#pragma once

#include <string_view>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

/// What a renderer said when `call` returned `code`, trusting neither its code nor its text.
[[nodiscard]] Error rendererError(std::string_view call, SluiceResult code, const SluiceError& said);

}  // namespace sluice::host
