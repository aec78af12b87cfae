// SPDX-License-Identifier: MIT
// What AUTO tries when the timeline that the renderer settled on fails at start-up.
#pragma once

#include <vector>

#include "sluice/plugin.h"

namespace sluice::host {

/// The kinds to try after `failed`, best first: each needs less of the drivers than the one before. Never
/// UNSYNCHRONISED; empty after FINISH and after anything that is no kind for frames.
[[nodiscard]] std::vector<SluiceTimelineKind> timelinesAfter(SluiceTimelineKind failed);

}  // namespace sluice::host
