// SPDX-License-Identifier: MIT
// page/page.html with its style and its script in place, embedded by CMake.
#pragma once

#include <string_view>

namespace sluice::cli {

/// Holds one "/*DATA*/" where the data belongs.
[[nodiscard]] std::string_view pageText();

}  // namespace sluice::cli
