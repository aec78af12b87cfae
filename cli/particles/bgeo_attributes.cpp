// SPDX-License-Identifier: MIT
#include "bgeo_attributes.hpp"

#include <fmt/format.h>

namespace sluice::particles::bgeo {

namespace {

Result<Kind> readKind(Cursor& cursor, const std::string& attribute) {
    const std::size_t at = cursor.at;
    const Result<std::uint32_t> number = cursor.take<std::uint32_t>("the type of attribute " + attribute);
    if (!number) {
        return number.error();
    }
    switch (number.value()) {
        case 0:
            return Kind::real;
        case 1:
            return Kind::integer;
        case 4:
            return Kind::index;
        case 5:
            return Kind::vector;
        default:
            break;
    }
    return failure(cursor.name, cursor.place(at),
                   fmt::format("type 0 (float), 1 (int), 4 (index) or 5 (vector) for attribute {}", attribute),
                   fmt::format("type {}", number.value()),
                   number.value() == 2 ? "delete the string attribute before exporting" : "the file is damaged");
}

/// Defaults of numbers, or the table of strings that an index attribute points into.
Status readDefaults(Cursor& cursor, Attribute& attribute, const std::string& shown) {
    if (attribute.kind == Kind::index) {
        const Result<std::uint32_t> strings = cursor.take<std::uint32_t>("the number of strings of attribute " + shown);
        if (!strings) {
            return strings.error();
        }
        for (std::uint32_t i = 0; i < strings.value(); ++i) {
            if (const Result<std::string> text = cursor.takeString("a string of attribute " + shown); !text) {
                return text.error();
            }
        }
        return {};
    }
    if (Status ok = cursor.need(std::uint64_t{attribute.size} * 4, "the defaults of attribute " + shown); !ok) {
        return ok;
    }
    for (std::uint32_t i = 0; i < attribute.size; ++i, cursor.at += 4) {
        if (attribute.kind != Kind::integer) {
            attribute.defaults.push_back(readBig<float>(cursor.bytes.data() + cursor.at));
        }
    }
    return {};
}

}  // namespace

Status Cursor::need(std::uint64_t size, const std::string& what) const {
    if (left() >= size) {
        return {};
    }
    return failure(name, place(at), fmt::format("{} bytes for {}", size, what),
                   fmt::format("{} bytes to the end of the file", left()), "the file is cut short");
}

Result<std::string> Cursor::takeString(const std::string& what) {
    const Result<std::uint16_t> brief = take<std::uint16_t>("the length of " + what);
    if (!brief) {
        return brief.error();
    }
    std::uint32_t length = brief.value();
    if (length == 0xFFFFU) {
        const Result<std::uint32_t> wide = take<std::uint32_t>("the length of " + what);
        if (!wide) {
            return wide.error();
        }
        length = wide.value();
    }
    if (const Status ok = need(length, what); !ok) {
        return ok.error();
    }
    std::string text(asText(bytes.subspan(at, length)));
    at += length;
    return text;
}

Result<std::vector<Attribute>> readAttributes(Cursor& cursor, std::uint64_t count, std::uint64_t first_offset,
                                              const std::string& of) {
    std::vector<Attribute> attributes;
    std::uint64_t offset = first_offset;
    for (std::uint64_t i = 0; i < count; ++i) {
        Attribute attribute;
        attribute.place = cursor.at;
        Result<std::string> name = cursor.takeString(fmt::format("the name of {} attribute {} of {}", of, i, count));
        if (!name) {
            return name.error();
        }
        attribute.name = std::move(name).value();
        const std::string shown = printable(attribute.name);
        const Result<std::uint16_t> size = cursor.take<std::uint16_t>("the size of attribute " + shown);
        if (!size) {
            return size.error();
        }
        attribute.size = size.value();
        const Result<Kind> kind = readKind(cursor, shown);
        if (!kind) {
            return kind.error();
        }
        attribute.kind = kind.value();
        if (const Status ok = readDefaults(cursor, attribute, shown); !ok) {
            return ok.error();
        }
        attribute.offset = offset;
        offset += std::uint64_t{attribute.size} * 4;
        attributes.push_back(std::move(attribute));
    }
    return attributes;
}

std::uint64_t recordSize(const std::vector<Attribute>& attributes, std::uint64_t first_offset) {
    return attributes.empty() ? first_offset : attributes.back().offset + std::uint64_t{attributes.back().size} * 4;
}

}  // namespace sluice::particles::bgeo
