// SPDX-License-Identifier: MIT
#include "report/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace sluice::cli {

std::string progressLine(std::uint64_t done, std::uint64_t total, double seconds, std::string_view doing) {
    constexpr std::size_t kWidth = 24;
    const std::size_t filled = total == 0 ? kWidth : static_cast<std::size_t>(kWidth * done / total);
    std::string line =
        fmt::format("[{}{}] {}/{} frames", std::string(filled, '#'), std::string(kWidth - filled, '-'), done, total);
    if (done > 0 && done < total) {
        const double each = seconds / static_cast<double>(done);
        line += fmt::format(", {:.2f} s each, {:.0f} s left", each, each * static_cast<double>(total - done));
    }
    return line + fmt::format(", {}", doing);
}

Progress::Progress(std::uint64_t total, bool wanted)
    : total_(total), wanted_(wanted && isatty(STDERR_FILENO) == 1), start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
    if (drawn_) {
        fmt::print(stderr, "\r\033[K");
        (void)std::fflush(stderr);
    }
}

void Progress::update(std::uint64_t done, std::string_view doing) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    if (!wanted_ || (total_ <= 1 && elapsed.count() <= 1.0)) {
        return;
    }
    fmt::print(stderr, "\r\033[K{}", progressLine(done, total_, elapsed.count(), doing));
    (void)std::fflush(stderr);
    drawn_ = true;
}

}  // namespace sluice::cli
