// SPDX-License-Identifier: MIT
#include "failure.hpp"

#include <fmt/format.h>

namespace sluice::particles {

namespace {

std::string describe(Place place) {
    switch (place.unit) {
        case Place::Unit::line:
            return fmt::format("line {}", place.value);
        case Place::Unit::inflated_byte:
            return fmt::format("byte {} of the inflated data", place.value);
        case Place::Unit::byte:
            break;
    }
    return fmt::format("byte {}", place.value);
}

}  // namespace

Error failure(const std::string& name, Place place, std::string_view expected, std::string_view found,
              std::string_view remedy) {
    return Error{SLUICE_ERROR_INVALID_ARGUMENT, name,
                 fmt::format("at {}: expected {}, found {}", describe(place), expected, found), std::string(remedy)};
}

std::string printable(std::string_view text) {
    constexpr std::size_t kMost = 40;
    std::string out = "'";
    for (const char c : text.substr(0, kMost)) {
        const auto code = static_cast<unsigned char>(c);
        if (code < 0x20 || code >= 0x7F) {
            out += fmt::format("\\x{:02x}", code);
        } else {
            out += c;
        }
    }
    out += text.size() > kMost ? "…'" : "'";
    return out;
}

}  // namespace sluice::particles
