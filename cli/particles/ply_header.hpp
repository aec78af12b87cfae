// SPDX-License-Identifier: MIT
// The text header of a PLY file: elements, properties, and the radius that `obj_info radius R` may carry.
// Layout: Greg Turk, "The PLY Polygon File Format", 1994.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bytes.hpp"
#include "sluice/result.hpp"

namespace sluice::particles::ply {

enum class Type : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

[[nodiscard]] std::size_t sizeOf(Type type);
[[nodiscard]] std::string_view nameOf(Type type);

struct Property {
    std::string name;
    Type type = Type::f32;
    std::optional<Type> list_count;  ///< set for a list: the type of its length
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::uint64_t line = 0;  ///< where the header declares it
    std::vector<Property> properties;
};

/// A header may declare this many elements, and each of them this many properties. Real files have a few dozen; each
/// name is compared with those before it, so that without a limit the time would grow with the square of the header.
inline constexpr std::size_t kMaxElements = 256;
inline constexpr std::size_t kMaxProperties = 256;

struct Header {
    bool binary = false;  ///< binary little-endian; else ascii
    std::vector<Element> elements;
    std::optional<float> radius;
    std::uint64_t radius_line = 0;
    std::size_t body = 0;         ///< byte offset of the first byte after the header
    std::uint64_t body_line = 0;  ///< 1-based line number of that byte
};

/// One line of text from `at`, without its ending (LF or CRLF), and the offset after it. Nothing at the end of the
/// text.
struct Line {
    std::string_view text;
    std::size_t next = 0;
};
[[nodiscard]] std::optional<Line> nextLine(std::string_view text, std::size_t at);

/// Cuts the next word off `text` (blanks and tabs separate); empty at the end of the line.
[[nodiscard]] std::string_view nextWord(std::string_view& text);

[[nodiscard]] Result<Header> parseHeader(Bytes bytes, const std::string& name);

}  // namespace sluice::particles::ply
