// SPDX-License-Identifier: MIT
// Making the host's end of the timelines.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "sluice/ledger/share_feed.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "sluice/timeline.hpp"
#include "sluice/trace.hpp"

namespace sluice::host {

/// What a backend works on. Everything pointed to must outlive the timeline.
struct TimelineDeps {
    const SluiceRendererApi* api = nullptr;
    SluiceRenderer* renderer = nullptr;
    Trace* trace = nullptr;               ///< nullptr: tracing off
    ledger::HandOffFeed* feed = nullptr;  ///< nullptr: no ledger
    ledger::ShareFeed* shares = nullptr;  ///< likewise
    std::function<void(SluiceLogLevel, std::string_view)> log;
    /// BRIDGED: how long destruction waits for fences that have not arrived before it lets the renderer go on without
    /// them.
    std::uint64_t drain_timeout_ns = 2'000'000'000ULL;
};

/// The backend for what the renderer settled on. A GL context must be current, and stays the one that the timeline is
/// used and destroyed with. Fails when the driver lacks what `kind` needs, naming it.
[[nodiscard]] Result<std::unique_ptr<HostTimeline>> makeHostTimeline(SluiceTimelineKind kind, const TimelineDeps& deps);

}  // namespace sluice::host
