// SPDX-License-Identifier: MIT
// The structs of sluice/sluice.h as they were in its version 1.0: none is shorter.
#pragma once

#include "sluice/abi_sizes.hpp"
#include "sluice/sluice.h"

namespace sluice {

template <>
inline constexpr std::size_t kAbiMinimum<SluiceOptions> = offsetof(SluiceOptions, log_user) +
                                                          sizeof(SluiceOptions::log_user);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceWater> = offsetof(SluiceWater, vorticity) +
                                                        sizeof(SluiceWater::vorticity);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceStatistics> = offsetof(SluiceStatistics, device) +
                                                             sizeof(SluiceStatistics::device);

/// The first `struct_size` bytes of T's defaults.
template <typename T>
void writeDefaults(T* to, const T& from, std::size_t struct_size) {
    if (to == nullptr || struct_size < sizeof(to->struct_size)) {
        return;
    }
    std::memset(to, 0, struct_size);
    std::memcpy(to, &from, std::min(struct_size, sizeof(T)));
    to->struct_size = static_cast<std::uint32_t>(struct_size);
}

}  // namespace sluice
