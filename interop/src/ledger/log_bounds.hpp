// SPDX-License-Identifier: MIT
// What the numbers of one event in a file may be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace sluice::ledger {

struct Outside {
    std::size_t at = 0;  ///< byte of the event
    const char* what = "";
    std::uint64_t found = 0, bound = 0;
};
/// The first field of the 48 bytes at `event` that is out of its bounds.
[[nodiscard]] std::optional<Outside> outsideOfBounds(const std::byte* event);

}  // namespace sluice::ledger
