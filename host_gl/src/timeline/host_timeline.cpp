// SPDX-License-Identifier: MIT
#include "timeline/host_timeline.hpp"

#include <fmt/format.h>

#include "timeline/backends.hpp"

namespace sluice::host {

Result<std::unique_ptr<HostTimeline>> makeHostTimeline(SluiceTimelineKind kind, const TimelineDeps& deps) {
    switch (kind) {
        case SLUICE_TIMELINE_NATIVE:
            return makeNativeTimeline(deps);
        case SLUICE_TIMELINE_BINARY:
            return makeBinaryTimeline(deps);
        case SLUICE_TIMELINE_BRIDGED:
            return makeBridgedTimeline(deps);
        case SLUICE_TIMELINE_FINISH:
            return makeFinishTimeline(deps);
        case SLUICE_TIMELINE_UNSYNCHRONISED:
            return makeUnsynchronisedTimeline(deps);
        case SLUICE_TIMELINE_AUTO:
        case SLUICE_TIMELINE_KIND_COUNT:
            break;
    }
    return Error{SLUICE_ERROR_INVALID_ARGUMENT, "timeline",
                 fmt::format("{} is not a kind that a renderer may settle on", static_cast<int>(kind)),
                 "the renderer is broken or newer than this host"};
}

}  // namespace sluice::host
