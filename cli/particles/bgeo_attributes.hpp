// SPDX-License-Identifier: MIT
// Classic Houdini geometry, version 5: a bounded big-endian reader and the attribute definitions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bytes.hpp"
#include "failure.hpp"
#include "sluice/result.hpp"

namespace sluice::particles::bgeo {

/// The type numbers of attribute definitions. A value takes 32 bits whatever its type.
enum class Kind : std::uint8_t { real = 0, integer = 1, index = 4, vector = 5 };

struct Attribute {
    std::string name;
    Kind kind = Kind::real;
    std::uint32_t size = 0;         ///< values per element
    std::uint64_t offset = 0;       ///< bytes from the start of an element's record
    std::size_t place = 0;          ///< byte of the definition
    std::vector<float> defaults{};  ///< of a real or vector attribute
};

/// Reads forwards and never past the end.
struct Cursor {
    Bytes bytes;
    const std::string& name;
    Place::Unit unit = Place::Unit::byte;
    std::size_t at = 0;

    [[nodiscard]] std::size_t left() const { return bytes.size() - at; }
    [[nodiscard]] Place place(std::size_t offset) const { return {unit, offset}; }
    /// An error unless `size` more bytes are there.
    [[nodiscard]] Status need(std::uint64_t size, const std::string& what) const;
    template <typename T>
    [[nodiscard]] Result<T> take(const std::string& what) {
        if (const Status ok = need(sizeof(T), what); !ok) {
            return ok.error();
        }
        const T value = readBig<T>(bytes.data() + at);
        at += sizeof(T);
        return value;
    }
    /// A 16-bit length (65535: a 32-bit length follows), then that many characters.
    [[nodiscard]] Result<std::string> takeString(const std::string& what);
};

/// `count` definitions. Their offsets start at `first_offset`.
[[nodiscard]] Result<std::vector<Attribute>> readAttributes(Cursor& cursor, std::uint64_t count,
                                                            std::uint64_t first_offset, const std::string& of);

/// The bytes of one record: `first_offset` plus what the attributes take.
[[nodiscard]] std::uint64_t recordSize(const std::vector<Attribute>& attributes, std::uint64_t first_offset);

}  // namespace sluice::particles::bgeo
