// SPDX-License-Identifier: MIT
#include "timeline/fallback.hpp"

#include <algorithm>
#include <array>

namespace sluice::host {

std::vector<SluiceTimelineKind> timelinesAfter(SluiceTimelineKind failed) {
    constexpr std::array kOrder{SLUICE_TIMELINE_NATIVE, SLUICE_TIMELINE_BINARY, SLUICE_TIMELINE_BRIDGED,
                                SLUICE_TIMELINE_FINISH};
    const auto* found = std::find(kOrder.begin(), kOrder.end(), failed);
    return found == kOrder.end() ? std::vector<SluiceTimelineKind>{} : std::vector(found + 1, kOrder.end());
}

}  // namespace sluice::host
