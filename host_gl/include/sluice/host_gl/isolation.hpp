// SPDX-License-Identifier: MIT
// A renderer plugin in a process of its own: what happens to that process does not happen to the host.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "sluice/host_gl/fault_plan.hpp"

namespace sluice::host {

/// Log lines and trace events of the process come on a thread of the host's own. A callback for them must not wait for
/// the thread that renders: while it does, calls of a process that has ended take up to 30 s to say so.
struct IsolationConfig {
    std::filesystem::path program;  ///< sluice-renderer
    std::filesystem::path plugin;
    /// Longest time that a call may take in the other process, what it has this one do for it apart; then it is killed
    /// and the call says so. 1 ms to 24 h; what lies outside is taken as the nearer of the two.
    std::uint64_t call_timeout_ns = 60'000'000'000ULL;
    std::optional<FaultPlan> fault;  ///< for tests; one of those that are ofProcess()
};

}  // namespace sluice::host
