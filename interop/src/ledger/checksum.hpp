// SPDX-License-Identifier: MIT
// CRC-32 as zlib computes it, which sluice_trace cannot link: an engine that logs shall need no other library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace sluice::ledger {

namespace checksum {

/// The remainder of a byte, its lowest bit first.
constexpr std::array<std::uint32_t, 256> table() {
    std::array<std::uint32_t, 256> remainders{};
    for (std::uint32_t byte = 0; byte < remainders.size(); ++byte) {
        std::uint32_t left = byte;
        for (int bit = 0; bit < 8; ++bit) {
            left = (left >> 1U) ^ ((left & 1U) != 0 ? 0xEDB88320U : 0U);
        }
        remainders.at(byte) = left;
    }
    return remainders;
}
inline constexpr std::array<std::uint32_t, 256> kTable = table();

}  // namespace checksum

/// Of `bytes`, or of what `before` was the checksum of with `bytes` behind it.
[[nodiscard]] inline std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before = 0) {
    std::uint32_t left = ~before;
    for (const std::byte byte : bytes) {
        left = (left >> 8U) ^ checksum::kTable[(left ^ static_cast<std::uint32_t>(byte)) & 0xFFU];
    }
    return ~left;
}

}  // namespace sluice::ledger
