// SPDX-License-Identifier: MIT
// Plain-text tables.
#pragma once

#include <string>
#include <vector>

namespace sluice::cli {

/// Columns as wide as their widest cell. The first row is the head. Columns named in `right` (by index) align right.
[[nodiscard]] std::string formatTable(const std::vector<std::vector<std::string>>& rows,
                                      const std::vector<std::size_t>& right);

/// "1.2 MiB"; exact below 1 KiB.
[[nodiscard]] std::string formatBytes(double bytes);
/// "96,161"
[[nodiscard]] std::string formatCount(unsigned long long count);

}  // namespace sluice::cli
