// SPDX-License-Identifier: MIT
// Guessing which word was meant.
#pragma once

#include <span>
#include <string_view>

namespace sluice::scene {

/// The word of `known` that takes the fewest insertions, deletions and changes to become `word`, or of which `word` is
/// a part; empty when none is near enough to have been meant.
[[nodiscard]] std::string_view nearest(std::string_view word, std::span<const std::string_view> known);

}  // namespace sluice::scene
