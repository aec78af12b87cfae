// SPDX-License-Identifier: MIT
// Runs one combination to its end and says what was seen. No OpenGL and no Vulkan type.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "stress/options.hpp"

namespace sluice::stress {

/// When a combination has done enough: whichever comes first.
struct Limit {
    std::uint64_t handoffs = 0;  ///< 0: no limit
    double seconds = 0.0;        ///< 0: no limit
};

/// Faults of one kind at one place, and who saw them.
struct FaultCounts {
    std::uint64_t injected = 0, by_pixels = 0, by_ledger = 0, by_both = 0, unseen = 0;
};

/// What became of one combination.
struct Row {
    Combination combination;
    std::uint64_t handoffs = 0;  ///< a signal of one API for which the other API has waited, or was to wait
    std::uint64_t checks = 0;    ///< times that every texel was compared
    double seconds = 0.0;
    std::uint64_t bad_texels = 0;
    std::uint64_t findings = 0;  ///< of the ledger, information left out
    // With a fault: how many were injected, and who saw them.
    std::uint64_t faults = 0, by_pixels = 0, by_ledger = 0, by_both = 0, unseen = 0;
    std::array<FaultCounts, 2> at{};     ///< the same by side: what OpenGL, what Vulkan did wrong
    std::uint64_t refused = 0;           ///< signals that the renderer's own guard refused
    std::vector<std::string> told;       ///< the ledger's findings
    std::optional<std::string> failure;  ///< why the row is no success
    std::vector<std::string> chain;      ///< who waited for whom when it hung
    std::string log;                     ///< where the ledger's log lies, if it was kept
    std::string log_error;               ///< why it could not be kept
    bool refused_here = false;           ///< the machine or this program cannot do it: nothing was run
    bool stuck = false;                  ///< the queue never ended: the process must leave without tidying up
    bool interrupted = false;
};

/// `log`: where to keep the ledger's log if this fails; empty: nowhere. Ends early, cleanly, when `stop` says so.
[[nodiscard]] Row runCombination(const Combination& combination, std::uint64_t seed, const Limit& limit,
                                 const std::string& log, const std::function<bool()>& stop);

}  // namespace sluice::stress
