// SPDX-License-Identifier: MIT
// GL's error flags as text. For creation and imports only: reading the flags in a frame would take the host's own.
#pragma once

#include <string>

namespace sluice::host {

/// Names of the pending flags, cleared; empty if there were none.
[[nodiscard]] std::string takeGlErrors();

}  // namespace sluice::host
