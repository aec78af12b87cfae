// SPDX-License-Identifier: MIT
// What `sluice stress` prints.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "stress/plan.hpp"
#include "stress/run.hpp"

namespace sluice::cli {

/// A table, a line per combination, and a sum.
[[nodiscard]] std::string stressText(const std::vector<stress::Row>& rows, std::uint64_t seed);
[[nodiscard]] nlohmann::ordered_json stressJson(const std::vector<stress::Row>& rows, const stress::Matrix& matrix,
                                                const stress::Options& options);
/// Why a row failed, who waited for whom, the command that repeats it, and where the log is.
[[nodiscard]] std::string failureText(const stress::Row& row, std::uint64_t seed);

}  // namespace sluice::cli
