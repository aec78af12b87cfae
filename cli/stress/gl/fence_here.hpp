// SPDX-License-Identifier: MIT
// Bridged without a bridge: the thread that draws waits for its own fence and then signals.
#pragma once

#include <memory>

#include "sluice/timeline.hpp"
#include "timeline/host_timeline.hpp"

namespace sluice::stress {

[[nodiscard]] std::unique_ptr<HostTimeline> makeFenceHere(const host::TimelineDeps& deps);

}  // namespace sluice::stress
