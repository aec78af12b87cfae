// SPDX-License-Identifier: MIT
#include "share/renderer_error.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

namespace sluice::host {

Error rendererError(std::string_view call, SluiceResult code, const SluiceError& said) {
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

}  // namespace sluice::host
