// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sluice/negotiate.hpp"

namespace sluice {

/// The best kind that both sides can do, or `forced`. Every kind's reason is added to `reasons`.
[[nodiscard]] Result<SluiceTimelineKind> chooseTimeline(const SluiceHostCapabilities& gl,
                                                        const SluiceRendererCapabilities& vk, SluiceTimelineKind forced,
                                                        std::vector<Reason>& reasons);

}  // namespace sluice
