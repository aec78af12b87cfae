// SPDX-License-Identifier: MIT
#include "sluice/abi_boundary.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>

#include "sluice/abi_sizes.hpp"

namespace sluice {

void writeAbiError(SluiceError* to, const Error& error) noexcept {
    if (to == nullptr) {
        return;
    }
    const std::size_t size = to->struct_size;
    constexpr std::size_t kHeader = offsetof(SluiceError, message);
    if (size < kHeader) {
        return;
    }
    to->code = error.code;
    const std::size_t room = std::min(size, sizeof(SluiceError)) - kHeader;
    if (room == 0) {
        return;
    }
    try {
        std::string text = error.message();
        if (text.empty()) {
            text = error.code == SLUICE_ERROR_OUT_OF_MEMORY ? "out of memory" : "an unknown failure";
        }
        const std::size_t length = std::min(text.size(), room - 1);
        std::memcpy(to->message, text.data(), length);
        to->message[length] = '\0';
    } catch (...) {
        to->message[0] = '\0';  // no memory for the text: the code says as much
    }
}

bool usableError(SluiceError* error) noexcept {
    try {
        if (error == nullptr) {
            return true;
        }
        const Status status = checkAbiStruct(error, "error");
        if (!status) {
            writeAbiError(error, status.error());
        }
        return status.ok();
    } catch (...) {
        return false;  // only an unusable struct needs memory for its message
    }
}

}  // namespace sluice
