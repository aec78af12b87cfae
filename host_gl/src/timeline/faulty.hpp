// SPDX-License-Identifier: MIT
// A timeline that makes one mistake.
#pragma once

#include <memory>

#include "sluice/host_gl/fault_plan.hpp"
#include "sluice/timeline.hpp"
#include "timeline/host_timeline.hpp"

namespace sluice::host {

/// `inner` with the fault of `plan`, which must be possible(). The ledger of `deps` hears of what `inner` really does
/// and of waits that end in vain, never of the fault.
[[nodiscard]] std::unique_ptr<HostTimeline> makeFaultyTimeline(std::unique_ptr<HostTimeline> inner,
                                                               const FaultPlan& plan, const TimelineDeps& deps);

}  // namespace sluice::host
