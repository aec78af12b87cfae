// SPDX-License-Identifier: MIT
// A renderer plugin in a process of its own: what happens to that process does not happen to the host.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
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
    /// The same for the calls that a frame makes: submit_frame, poll, timeline_value, timeline_export, simulate,
    /// simulation_stats, simulation_bodies, set_body and set_flow. 0, or more than the other: as the other.
    std::uint64_t frame_call_timeout_ns = 0;
    /// Asked several times a second by the thread that waits in a call; may be empty. Once it says yes, the call may
    /// take 2 s more. It must not throw.
    std::function<bool()> hurry;
    /// The processes are no children of this one, which neither its wait() nor its SIGCHLD handler will hear of; how
    /// they ended is then not known. Where the kernel has no pidfd (before 5.3) they are children all the same.
    bool detached = false;
    std::optional<FaultPlan> fault;  ///< for tests; one of those that are ofProcess()
};

/// After how long the process of a call is killed; 0: never, for there is none.
struct CallLimits {
    std::uint64_t call_ns = 0;
    std::uint64_t frame_call_ns = 0;
};
[[nodiscard]] CallLimits limitsOf(const IsolationConfig& config);

}  // namespace sluice::host
