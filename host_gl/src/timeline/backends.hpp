// SPDX-License-Identifier: MIT
// One factory per backend; makeHostTimeline chooses among them.
#pragma once

#include <memory>

#include "sluice/result.hpp"
#include "sluice/timeline.hpp"
#include "timeline/host_timeline.hpp"

namespace sluice::host {

[[nodiscard]] Result<std::unique_ptr<HostTimeline>> makeNativeTimeline(const TimelineDeps& deps);
[[nodiscard]] Result<std::unique_ptr<HostTimeline>> makeBinaryTimeline(const TimelineDeps& deps);
[[nodiscard]] Result<std::unique_ptr<HostTimeline>> makeBridgedTimeline(const TimelineDeps& deps);
[[nodiscard]] std::unique_ptr<HostTimeline> makeFinishTimeline(const TimelineDeps& deps);
[[nodiscard]] std::unique_ptr<HostTimeline> makeUnsynchronisedTimeline(const TimelineDeps& deps);

}  // namespace sluice::host
