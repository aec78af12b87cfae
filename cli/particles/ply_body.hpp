// SPDX-License-Identifier: MIT
// The values of a PLY file, one at a time, from text lines or from little-endian bytes, behind one face.
#pragma once

#include <cstdint>
#include <string>

#include "failure.hpp"
#include "ply_header.hpp"

namespace sluice::particles::ply {

/// Walks the body: begin an instance of an element, take its values in order, end it. The place names what was read
/// last.
class Body {
  public:
    Body(Bytes bytes, const Header& header, const std::string& name);

    /// Refuses an element of a binary file that cannot fit into what is left.
    [[nodiscard]] Status beginElement(const Element& element);
    /// How many instances of the element begun, of three values or more, there can be at most: what may be reserved.
    [[nodiscard]] std::uint64_t mostInstances() const;
    [[nodiscard]] Status beginInstance();
    [[nodiscard]] Result<double> take(const Property& property);
    /// Passes over a scalar or a list.
    [[nodiscard]] Status skip(const Property& property);
    [[nodiscard]] Status endInstance();
    /// Nothing but blank lines (ascii) or nothing at all (binary) may follow the last element.
    [[nodiscard]] Status end();

    [[nodiscard]] Place place() const;

  private:
    [[nodiscard]] Result<double> takeNumber(Type type, const std::string& what);
    [[nodiscard]] Result<double> takeText(Type type, const std::string& what);
    [[nodiscard]] Result<std::uint64_t> takeLength(const Property& property);

    Bytes bytes_;
    const std::string& name_;
    const Element* element_ = nullptr;
    std::uint64_t instance_ = 0;
    bool binary_ = false;
    std::size_t at_ = 0;     ///< binary: the next byte; ascii: the next line's first byte
    std::size_t place_ = 0;  ///< binary: the byte of the value taken last
    std::uint64_t line_ = 0;
    std::string_view rest_;
};

}  // namespace sluice::particles::ply
