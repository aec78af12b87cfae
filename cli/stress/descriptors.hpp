// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <iterator>
#include <system_error>

namespace sluice::stress {

/// Descriptors that this process has open.
[[nodiscard]] inline std::uint64_t openDescriptors() {
    std::error_code ignored;
    const std::filesystem::directory_iterator open("/proc/self/fd", ignored);
    return static_cast<std::uint64_t>(std::distance(begin(open), end(open)));
}

}  // namespace sluice::stress
