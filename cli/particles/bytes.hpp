// SPDX-License-Identifier: MIT
// Numbers of stated byte order from and to bytes, whatever the order of this machine.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace sluice::particles {

using Bytes = std::span<const std::byte>;

/// The unsigned integer as wide as T.
template <typename T>
using BitsOf = std::conditional_t<sizeof(T) == 1, std::uint8_t,
                                  std::conditional_t<sizeof(T) == 2, std::uint16_t,
                                                     std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;

/// Reads a T at `at`; the caller has checked that sizeof(T) bytes are there.
template <typename T, std::endian order>
[[nodiscard]] T readNumber(const std::byte* at) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        const std::size_t from = order == std::endian::big ? i : sizeof(T) - 1 - i;
        bits = bits << 8U | std::to_integer<std::uint64_t>(at[from]);
    }
    return std::bit_cast<T>(static_cast<BitsOf<T>>(bits));
}

template <typename T>
[[nodiscard]] T readLittle(const std::byte* at) {
    return readNumber<T, std::endian::little>(at);
}

template <typename T>
[[nodiscard]] T readBig(const std::byte* at) {
    return readNumber<T, std::endian::big>(at);
}

/// Appends a T.
template <typename T, std::endian order>
void appendNumber(std::vector<std::byte>& out, T value) {
    const auto bits = static_cast<std::uint64_t>(std::bit_cast<BitsOf<T>>(value));
    // Grown once and then filled: GCC 14 at -O3 misreads the growth inside push_back (-Wfree-nonheap-object).
    const std::size_t begin = out.size();
    out.resize(begin + sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        const std::size_t shift = 8 * (order == std::endian::big ? sizeof(T) - 1 - i : i);
        out[begin + i] = static_cast<std::byte>(bits >> shift & 0xFFU);
    }
}

template <typename T>
void appendLittle(std::vector<std::byte>& out, T value) {
    appendNumber<T, std::endian::little>(out, value);
}

template <typename T>
void appendBig(std::vector<std::byte>& out, T value) {
    appendNumber<T, std::endian::big>(out, value);
}

inline void appendText(std::vector<std::byte>& out, std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    out.insert(out.end(), bytes.begin(), bytes.end());
}

/// The bytes as characters, for the text parts of a file.
[[nodiscard]] inline std::string_view asText(Bytes bytes) {
    return {static_cast<const char*>(static_cast<const void*>(bytes.data())), bytes.size()};
}

}  // namespace sluice::particles
