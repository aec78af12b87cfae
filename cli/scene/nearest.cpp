// SPDX-License-Identifier: MIT
#include "nearest.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace sluice::scene {
namespace {

/// Letters from which on a part is taken for the word.
constexpr std::size_t kPart = 3;

/// Levenshtein distance, one row at a time.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
        }
    }
    return row.back();
}

}  // namespace

std::string_view nearest(std::string_view word, std::span<const std::string_view> known) {
    const auto part = std::find_if(known.begin(), known.end(), [word](std::string_view one) {
        return word.size() >= kPart && one.find(word) != std::string_view::npos;
    });
    if (part != known.end()) {
        return *part;
    }
    const auto best = std::min_element(known.begin(), known.end(), [word](std::string_view a, std::string_view b) {
        return distance(a, word) < distance(b, word);
    });
    const bool near = best != known.end() && distance(*best, word) <= std::max<std::size_t>(1, word.size() / 3);
    return near ? *best : std::string_view{};
}

}  // namespace sluice::scene
