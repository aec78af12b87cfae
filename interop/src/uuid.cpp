// SPDX-License-Identifier: MIT
#include "sluice/uuid.hpp"

#include <fmt/format.h>

namespace sluice {

std::string uuidText(std::span<const std::uint8_t, SLUICE_UUID_SIZE> uuid) {
    std::string text;
    for (std::size_t i = 0; i < uuid.size(); ++i) {
        if (i == 4 || i == 6 || i == 8 || i == 10) {
            text += '-';
        }
        text += fmt::format("{:02x}", uuid[i]);
    }
    return text;
}

}  // namespace sluice
