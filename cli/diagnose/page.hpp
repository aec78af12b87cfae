// SPDX-License-Identifier: MIT
// A diagnosis as one HTML file that needs nothing else.
#pragma once

#include <cstdint>
#include <string>

#include "diagnose/diagnosis.hpp"

namespace sluice::cli {

/// Frames that one page holds; a browser draws a few of them at a time.
inline constexpr std::size_t kPageFrames = 2000;

struct PageRange {
    std::uint32_t first = 0, last = 0xFFFFFFFF;  ///< frames
};
/// Of a log with more than kPageFrames in `range`, the page holds as many from the first finding on, and says so.
[[nodiscard]] std::string diagnosisPage(const Diagnosis& diagnosis, PageRange range = {});

}  // namespace sluice::cli
