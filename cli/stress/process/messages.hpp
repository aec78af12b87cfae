// SPDX-License-Identifier: MIT
// What the host says to the Vulkan side in its own process, and what that answers: two structs of fixed size. Both ends
// are of one build, so that they cross as they lie in memory. No value of a timeline is among them but those that a
// submission waits for and signals: order goes through shared memory only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "stress/slots.hpp"

namespace sluice::stress {

/// Beside the program that starts it.
inline constexpr std::string_view kVulkanProgram = "sluice-stress-vulkan";

enum class Call : std::uint32_t {
    Open,        ///< the device of `host`
    Allocate,    ///< `storage`, with the memory of new timelines
    Export,      ///< `slot`; answered with its memory
    Submit,      ///< `turn` and `hand`
    Read,        ///< `slot`; answered with sealed memory of its texels
    Descriptors  ///< how many are open over there
};

/// What submit needs to know of a Turn.
struct WireTurn {
    std::uint32_t input_count = 0;
    std::array<std::uint32_t, kMaxInputs> inputs{};
    std::uint32_t output = 0, salt = 0;
};

struct Request {
    Call call = Call::Open;
    std::uint32_t slot = 0;
    SluiceHostCapabilities host{};
    Storage storage;
    WireTurn turn;
    Hand hand;
};

struct Answer {
    std::int32_t code = SLUICE_OK;
    std::array<char, 128> thing{};
    std::array<char, 512> detail{};
    std::array<char, 256> remedy{};
    SluiceRendererCapabilities renderer{};
    std::uint64_t count = 0;  ///< bytes, descriptors
};

template <typename T>
[[nodiscard]] std::span<const std::byte> bytesOf(const T& message) {
    static_assert(std::is_trivially_copyable_v<T>);
    return std::as_bytes(std::span(&message, 1));
}
/// Nothing unless `bytes` are as many as a T has.
template <typename T>
[[nodiscard]] std::optional<T> messageIn(std::span<const std::byte> bytes) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (bytes.size() != sizeof(T)) {
        return std::nullopt;
    }
    T message;
    std::memcpy(&message, bytes.data(), sizeof(T));
    return message;
}

}  // namespace sluice::stress
