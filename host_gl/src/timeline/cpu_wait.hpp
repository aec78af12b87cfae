// SPDX-License-Identifier: MIT
// The wait of every backend that blocks on the CPU.
#pragma once

#include <atomic>
#include <cstdint>

#include "sluice/result.hpp"
#include "timeline/host_timeline.hpp"

namespace sluice::host {

/// Blocks until the renderer-to-host counter reaches `value`; SLUICE_TIMEOUT after `timeout_ns`. Gives up early with
/// SLUICE_ERROR_DEVICE_LOST soon after `hopeless` (may be nullptr) becomes true; whoever set it tells why.
[[nodiscard]] Status waitOnCpu(const TimelineDeps& deps, std::uint64_t value, std::uint64_t timeout_ns,
                               const std::atomic<bool>* hopeless);
/// A wait for `value` of the renderer that began at `begin_ns` has passed its deadline: the log gets the chain of those
/// who wait for each other, and the ledger the wait. Nothing without a ledger.
void tellWatchdog(const TimelineDeps& deps, std::uint64_t value, std::uint64_t begin_ns);
/// Raises the host-to-renderer counter from the CPU and records it on `track`.
[[nodiscard]] Status signalFromCpu(const TimelineDeps& deps, std::uint64_t value, SluiceTrack track);

}  // namespace sluice::host
