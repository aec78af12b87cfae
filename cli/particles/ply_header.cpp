// SPDX-License-Identifier: MIT
#include "ply_header.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include <fmt/format.h>

#include "builder.hpp"
#include "failure.hpp"

namespace sluice::particles::ply {

namespace {

struct TypeName {
    std::string_view name;
    Type type;
};
constexpr std::array<TypeName, 16> kTypes{{{"char", Type::i8},
                                           {"uchar", Type::u8},
                                           {"short", Type::i16},
                                           {"ushort", Type::u16},
                                           {"int", Type::i32},
                                           {"uint", Type::u32},
                                           {"float", Type::f32},
                                           {"double", Type::f64},
                                           {"int8", Type::i8},
                                           {"uint8", Type::u8},
                                           {"int16", Type::i16},
                                           {"uint16", Type::u16},
                                           {"int32", Type::i32},
                                           {"uint32", Type::u32},
                                           {"float32", Type::f32},
                                           {"float64", Type::f64}}};

constexpr std::string_view kTypeList = "one of char uchar short ushort int uint float double";

std::optional<Type> typeNamed(std::string_view word) {
    const auto* found = std::ranges::find(kTypes, word, &TypeName::name);
    return found == kTypes.end() ? std::nullopt : std::optional(found->type);
}

/// The words after "format".
Status parseFormat(Header& header, std::string_view rest, const std::string& name, std::uint64_t line) {
    const std::string_view kind = nextWord(rest);
    const std::string_view version = nextWord(rest);
    if (kind == "binary_big_endian") {
        return failure(name, atLine(line), "format ascii or binary_little_endian", "binary_big_endian",
                       "export it again as ascii or binary little-endian PLY");
    }
    if ((kind != "ascii" && kind != "binary_little_endian") || version != "1.0") {
        return failure(name, atLine(line), "'format ascii 1.0' or 'format binary_little_endian 1.0'",
                       fmt::format("format {} {}", printable(kind), printable(version)));
    }
    header.binary = kind != "ascii";
    return {};
}

/// The words after "element".
Status parseElement(Header& header, std::string_view rest, const std::string& name, std::uint64_t line) {
    const std::string_view element = nextWord(rest);
    const std::string_view count = nextWord(rest);
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), value);
    if (element.empty() || error != std::errc() || end != count.data() + count.size() || !nextWord(rest).empty()) {
        return failure(name, atLine(line), "'element NAME COUNT'",
                       fmt::format("element {} {}", printable(element), printable(count)));
    }
    if (header.elements.size() == kMaxElements) {
        return failure(name, atLine(line), fmt::format("at most {} elements", kMaxElements), "one more",
                       "export the particles alone");
    }
    if (std::ranges::find(header.elements, element, &Element::name) != header.elements.end()) {
        return failure(name, atLine(line), "each element once", fmt::format("{} again", printable(element)));
    }
    if (Status ok = element == "vertex" ? checkCount(name, value, atLine(line)) : Status(); !ok) {
        return ok;
    }
    header.elements.push_back({std::string(element), value, line, {}});
    return {};
}

/// The words after "property".
Status parseProperty(Header& header, std::string_view rest, const std::string& name, std::uint64_t line) {
    if (header.elements.empty()) {
        return failure(name, atLine(line), "an element before its properties", "a property");
    }
    Property property;
    std::string_view word = nextWord(rest);
    if (word == "list") {
        const std::string_view count = nextWord(rest);
        property.list_count = typeNamed(count);
        if (!property.list_count || *property.list_count == Type::f32 || *property.list_count == Type::f64) {
            return failure(name, atLine(line), "an integer type for the length of a list", printable(count));
        }
        word = nextWord(rest);
    }
    const std::optional<Type> type = typeNamed(word);
    if (!type) {
        return failure(name, atLine(line), kTypeList, printable(word));
    }
    property.type = *type;
    property.name = nextWord(rest);
    if (property.name.empty() || !nextWord(rest).empty()) {
        return failure(name, atLine(line), "one name after the type of a property", printable(property.name));
    }
    std::vector<Property>& all = header.elements.back().properties;
    if (all.size() == kMaxProperties) {
        return failure(name, atLine(line), fmt::format("at most {} properties of an element", kMaxProperties),
                       "one more", "export the particles alone");
    }
    if (std::ranges::find(all, property.name, &Property::name) != all.end()) {
        return failure(name, atLine(line), "each property once", fmt::format("{} again", printable(property.name)));
    }
    all.push_back(std::move(property));
    return {};
}

/// The words after "obj_info": only `radius R` means something here.
Status parseInfo(Header& header, std::string_view rest, const std::string& name, std::uint64_t line) {
    if (nextWord(rest) != "radius") {
        return {};
    }
    const std::string_view word = nextWord(rest);
    float value = 0.0F;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
        return failure(name, atLine(line), "a number after 'obj_info radius'", printable(word));
    }
    header.radius = value;
    header.radius_line = line;
    return {};
}

Status parseKeyword(Header& header, std::string_view keyword, std::string_view rest, const std::string& name,
                    std::uint64_t line) {
    if (keyword == "element") {
        return parseElement(header, rest, name, line);
    }
    if (keyword == "property") {
        return parseProperty(header, rest, name, line);
    }
    if (keyword == "obj_info") {
        return parseInfo(header, rest, name, line);
    }
    if (keyword == "comment" || keyword.empty()) {
        return {};
    }
    return failure(name, atLine(line), "format, element, property, comment, obj_info or end_header",
                   printable(keyword));
}

}  // namespace

std::size_t sizeOf(Type type) {
    constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

std::string_view nameOf(Type type) {
    return kTypes[static_cast<std::size_t>(type)].name;
}

std::optional<Line> nextLine(std::string_view text, std::size_t at) {
    if (at >= text.size()) {
        return std::nullopt;
    }
    const std::size_t end = text.find('\n', at);
    Line line{text.substr(at, end == std::string_view::npos ? end : end - at),
              end == std::string_view::npos ? text.size() : end + 1};
    if (line.text.ends_with('\r')) {
        line.text.remove_suffix(1);
    }
    return line;
}

std::string_view nextWord(std::string_view& text) {
    constexpr std::string_view kBlanks = " \t";
    const std::size_t from = text.find_first_not_of(kBlanks);
    if (from == std::string_view::npos) {
        text = {};
        return {};
    }
    text.remove_prefix(from);
    const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
    text.remove_prefix(word.size());
    return word;
}

Result<Header> parseHeader(Bytes bytes, const std::string& name) {
    const std::string_view text = asText(bytes);
    if (text.empty()) {
        return failure(name, atByte(0), "'ply'", "an empty file", "the file was never written; export it again");
    }
    std::optional<Line> line = nextLine(text, 0);
    if (!line || line->text != "ply") {
        return failure(name, atByte(0), "'ply' alone on the first line", printable(text.substr(0, 16)),
                       "this is not a PLY file");
    }
    Header header;
    bool has_format = false;
    for (std::uint64_t number = 2;; ++number) {
        line = nextLine(text, line->next);
        if (!line) {
            return failure(name, atByte(text.size()), "'end_header'", "the end of the file", "the file is cut short");
        }
        std::string_view rest = line->text;
        const std::string_view keyword = nextWord(rest);
        if (keyword == "format" && !has_format) {
            has_format = true;
            if (const Status ok = parseFormat(header, rest, name, number); !ok) {
                return ok.error();
            }
            continue;
        }
        if (keyword == "end_header") {
            if (!has_format) {
                return failure(name, atLine(number), "a 'format' line before 'end_header'", "none");
            }
            header.body = line->next;
            header.body_line = number + 1;
            return header;
        }
        if (const Status ok = parseKeyword(header, keyword, rest, name, number); !ok) {
            return ok.error();
        }
    }
}

}  // namespace sluice::particles::ply
