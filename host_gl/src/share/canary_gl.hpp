// SPDX-License-Identifier: MIT
// The GL half of the canary round trip.
#pragma once

#include <cstdint>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::ledger {
class ShareFeed;
}

namespace sluice::host {

/// Imports `image`, compares every texel with canaryPattern(format, seed), writes canaryPattern(format, seed + 1),
/// finishes and lets go of the image. fd as for importImage. A differing texel is SLUICE_ERROR_CANARY, with the fd
/// untouched. `feed` as for importImage.
[[nodiscard]] Status runCanary(const SluiceImageExport& image, std::uint32_t seed, ledger::ShareFeed* feed = nullptr);

}  // namespace sluice::host
