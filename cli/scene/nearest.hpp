// SPDX-License-Identifier: MIT
// Guessing which word was meant.
#pragma once

#include <span>
#include <string_view>

namespace sluice::scene {

/// The word of `known`, which is not empty, that takes the fewest insertions, deletions and changes to become `word`.
[[nodiscard]] std::string_view nearest(std::string_view word, std::span<const std::string_view> known);

}  // namespace sluice::scene
