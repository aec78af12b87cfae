// SPDX-License-Identifier: MIT
// What the log has heard of already.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

namespace sluice::host {

/// A failure's text with a # for each number: a camera that turns, or a window that is drawn larger, gives one text
/// with other numbers in each frame. Numbers are what begins with a digit, and nan and inf; a sign belongs to its
/// number.
[[nodiscard]] std::string withoutNumbers(std::string_view text);

/// How much of a failure's text says which failure it is.
enum class Once {
    Kind,  ///< all but its numbers: of calls that an engine makes in every frame
    Text   ///< all of it: of calls that it makes now and then, on other data each time
};

class Told {
  public:
    /// Whether the log has not heard of it. Never forgets: what comes back after good frames is known.
    [[nodiscard]] bool isNews(const std::string& text, Once once);

  private:
    static constexpr std::size_t kMostTexts = 64;  // an engine may make up any number of them

    std::set<std::string> kinds_, texts_;
};

}  // namespace sluice::host
