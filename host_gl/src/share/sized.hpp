// SPDX-License-Identifier: MIT
// Structs of the plugin ABI as the other side filled them.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

/// A copy in which every field that `source` is too short for is zero.
template <typename T>
[[nodiscard]] T readSized(const T& source) {
    T copy{};
    std::memcpy(&copy, &source, std::min<std::size_t>(source.struct_size, sizeof(T)));
    copy.struct_size = sizeof(T);
    return copy;
}

/// An empty T that says its size.
template <typename T>
[[nodiscard]] T sized() {
    T value{};
    value.struct_size = sizeof(T);
    return value;
}

/// What a renderer said when `call` returned `code`, trusting neither its code nor its text.
[[nodiscard]] inline Error rendererError(std::string_view call, SluiceResult code, const SluiceError& said) {
    const std::size_t length = strnlen(said.message, sizeof(said.message));
    std::string text(said.message, length);
    // One line of printable text or UTF-8, whatever arrived.
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    if (text.empty()) {
        text = "failed with code " + std::to_string(static_cast<int>(code)) + " and no message";
    }
    // A positive code is no failure by the contract, but what it came from did not succeed.
    const bool known = code < 0 && code >= SLUICE_ERROR_INTERNAL;
    return Error{known || code == SLUICE_TIMEOUT ? code : SLUICE_ERROR_INTERNAL, "renderer " + std::string(call),
                 std::move(text), ""};
}

/// Fills the other side's error struct, if there is one, as far as its size allows.
inline SluiceResult tellError(SluiceError* target, const Error& error) noexcept {
    constexpr std::size_t kHead = offsetof(SluiceError, message);
    if (target != nullptr && target->struct_size > kHead) {
        target->code = error.code;
        const std::size_t room = std::min<std::size_t>(target->struct_size - kHead, sizeof(target->message));
        const std::string text = error.message();
        const std::size_t length = std::min(text.size(), room - 1);
        std::memcpy(target->message, text.data(), length);
        target->message[length] = '\0';
    }
    return error.code;
}

}  // namespace sluice::host
