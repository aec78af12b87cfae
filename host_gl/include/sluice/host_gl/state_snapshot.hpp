// SPDX-License-Identifier: MIT
// A snapshot of every GL state that can be queried, to prove that a piece of code leaves none behind.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sluice::host {

/// Name and value of each queried state of the current context, in a fixed order.
using StateSnapshot = std::vector<std::pair<std::string, std::string>>;

[[nodiscard]] StateSnapshot takeStateSnapshot();
/// One line per state that differs: "GL_BLEND: 0 -> 1". Empty when equal.
[[nodiscard]] std::vector<std::string> differences(const StateSnapshot& before, const StateSnapshot& after);

}  // namespace sluice::host
