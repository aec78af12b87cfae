// SPDX-License-Identifier: MIT
// What the end of an epoch says about it. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "stress/options.hpp"

namespace sluice::stress {

/// What was seen between two checks.
struct Seen {
    Fault fault = Fault::None;
    bool injected = false;         ///< the fault's round was played
    std::uint64_t bad_texels = 0;  ///< at the check
    std::uint64_t findings = 0;    ///< of the ledger
    std::uint64_t refused = 0;     ///< signals that the renderer's guard refused
};

/// Why the epoch is no success, or nothing.
[[nodiscard]] std::optional<std::string> whyFailed(const Seen& seen);

}  // namespace sluice::stress
