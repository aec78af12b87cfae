// SPDX-License-Identifier: MIT
// A progress bar for a person at a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace sluice::cli {

/// The bar's text: "[####----] 3/10 frames, 0.8 s each, 6 s left". `seconds` is the time spent on `done` frames.
[[nodiscard]] std::string progressLine(std::uint64_t done, std::uint64_t total, double seconds, std::string_view doing);

/// Draws on stderr, and only if that is a terminal and there is more than one frame or more than a second of work.
class Progress {
  public:
    Progress(std::uint64_t total, bool wanted);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    /// Wipes the bar.
    ~Progress();
    void update(std::uint64_t done, std::string_view doing);

  private:
    std::uint64_t total_;
    bool wanted_;
    bool drawn_ = false;
    std::chrono::steady_clock::time_point start_;
};

}  // namespace sluice::cli
