// SPDX-License-Identifier: MIT
// A diagnosis for a terminal, and as JSON for a program.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "diagnose/diagnosis.hpp"

namespace sluice::cli {

struct TextOptions {
    std::size_t per_kind = 3;            ///< findings told in full
    std::optional<std::uint32_t> frame;  ///< whose critical path and stalls are printed; the longest if none is named
};
[[nodiscard]] std::string diagnosisText(const Diagnosis& diagnosis, const TextOptions& options);
/// docs/diagnose.md has the schema. Times are nanoseconds after `origin_ns`.
[[nodiscard]] nlohmann::ordered_json diagnosisJson(const Diagnosis& diagnosis);

}  // namespace sluice::cli
