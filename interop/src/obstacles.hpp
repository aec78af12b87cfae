// SPDX-License-Identifier: MIT
// What stands in the way of a choice.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace sluice {

struct Requirement {
    bool met;
    std::string_view missing;  ///< told when it is not
};

/// "a is missing; b is missing", empty when everything is met.
[[nodiscard]] inline std::string obstacles(std::initializer_list<Requirement> requirements) {
    std::string why;
    for (const Requirement& requirement : requirements) {
        if (!requirement.met) {
            why += why.empty() ? "" : "; ";
            why += requirement.missing;
        }
    }
    return why;
}

}  // namespace sluice
