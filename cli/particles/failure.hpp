// SPDX-License-Identifier: MIT
// The one wording of "this file is not what it should be": file, place, expected, found, remedy.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sluice/result.hpp"

namespace sluice::particles {

/// Where in a file: "byte 12" or "line 3".
struct Place {
    enum class Unit : std::uint8_t { byte, line, inflated_byte };
    Unit unit = Unit::byte;
    std::uint64_t value = 0;
};

[[nodiscard]] inline Place atByte(std::uint64_t offset) {
    return {Place::Unit::byte, offset};
}
[[nodiscard]] inline Place atLine(std::uint64_t line) {
    return {Place::Unit::line, line};
}

/// An Error with code SLUICE_ERROR_INVALID_ARGUMENT: "<name>: at <place>: expected <expected>, found <found>
/// (<remedy>)".
[[nodiscard]] Error failure(const std::string& name, Place place, std::string_view expected, std::string_view found,
                            std::string_view remedy = {});

/// Text of a file made safe to print: quoted, cut to 40 bytes, unprintable bytes as \xNN.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace sluice::particles
