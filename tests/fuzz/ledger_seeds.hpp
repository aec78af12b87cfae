// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace sluice::fuzz {

/// Small logs that together hold every type of chunk and every kind of event.
[[nodiscard]] bool writeLedgerSeeds(const std::filesystem::path& folder);

}  // namespace sluice::fuzz
