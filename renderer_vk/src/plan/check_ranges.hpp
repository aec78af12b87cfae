// SPDX-License-Identifier: MIT
#pragma once

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Every number that the plan goes by is in range. INVALID_ARGUMENT otherwise, naming field, value and range.
[[nodiscard]] Status checkRanges(const SluiceSceneNeeds& needs);

}  // namespace sluice::vk
