// SPDX-License-Identifier: MIT
#include "ply_body.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace sluice::particles::ply {

namespace {

double decode(Type type, const std::byte* at) {
    switch (type) {
        case Type::i8:
            return readLittle<std::int8_t>(at);
        case Type::u8:
            return readLittle<std::uint8_t>(at);
        case Type::i16:
            return readLittle<std::int16_t>(at);
        case Type::u16:
            return readLittle<std::uint16_t>(at);
        case Type::i32:
            return readLittle<std::int32_t>(at);
        case Type::u32:
            return readLittle<std::uint32_t>(at);
        case Type::f32:
            return static_cast<double>(readLittle<float>(at));
        case Type::f64:
            break;
    }
    return readLittle<double>(at);
}

/// The least bytes that one instance takes in a binary file.
std::uint64_t leastBytes(const Element& element) {
    std::uint64_t least = 0;
    for (const Property& property : element.properties) {
        least += sizeOf(property.list_count.value_or(property.type));
    }
    return std::max<std::uint64_t>(least, 1);  // an element has properties, each of a byte at least
}

template <typename T>
bool readWord(std::string_view word, T& value) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

Body::Body(Bytes bytes, const Header& header, const std::string& name)
    : bytes_(bytes),
      name_(name),
      binary_(header.binary),
      at_(header.body),
      place_(header.body),
      line_(header.body_line - 1) {}

Place Body::place() const {
    return binary_ ? atByte(place_) : atLine(line_);
}

Status Body::beginElement(const Element& element) {
    element_ = &element;
    instance_ = 0;
    place_ = at_;
    if (element.count > 0 && element.properties.empty()) {
        return failure(name_, atLine(element.line), fmt::format("properties for element {}", printable(element.name)),
                       "none");
    }
    // A text is not judged by its size: the line that is wrong or missing says more.
    if (binary_ && element.count > 0 && (bytes_.size() - at_) / leastBytes(element) < element.count) {
        return failure(name_, atByte(at_),
                       fmt::format("{} of element {}, at least {} bytes each", element.count, printable(element.name),
                                   leastBytes(element)),
                       fmt::format("{} bytes to the end of the file", bytes_.size() - at_),
                       "the file is cut short, or its header claims too much");
    }
    return {};
}

std::uint64_t Body::mostInstances() const {
    // In a text, three values take a digit and a separator each, but for the last.
    return binary_ ? element_->count : std::min<std::uint64_t>(element_->count, (bytes_.size() - at_ + 1) / 6);
}

Status Body::beginInstance() {
    if (binary_) {
        return {};
    }
    while (const std::optional<Line> line = nextLine(asText(bytes_), at_)) {
        at_ = line->next;
        ++line_;
        rest_ = line->text;
        std::string_view probe = rest_;
        if (!nextWord(probe).empty()) {
            return {};
        }
    }
    return failure(name_, atLine(line_ + 1), fmt::format("{} {} of {}", element_->name, instance_, element_->count),
                   "the end of the file", "the file is cut short");
}

Result<double> Body::takeText(Type type, const std::string& what) {
    std::string_view word = nextWord(rest_);
    const std::string_view shown = word;
    if (word.starts_with('+')) {
        word.remove_prefix(1);
    }
    // A float is read as a float: going through double would round twice.
    double value = 0.0;
    float narrow = 0.0F;
    const bool read = type == Type::f32 ? readWord(word, narrow) : readWord(word, value);
    if (!read) {
        return failure(name_, place(), fmt::format("a number ({}) for {}", nameOf(type), what),
                       shown.empty() ? "the end of the line" : printable(shown));
    }
    return type == Type::f32 ? static_cast<double>(narrow) : value;
}

Result<double> Body::takeNumber(Type type, const std::string& what) {
    if (!binary_) {
        return takeText(type, what);
    }
    place_ = at_;
    if (bytes_.size() - at_ < sizeOf(type)) {
        return failure(name_, atByte(at_),
                       fmt::format("{} bytes for {} of {} {}", sizeOf(type), what, element_->name, instance_),
                       fmt::format("{} bytes to the end of the file", bytes_.size() - at_), "the file is cut short");
    }
    at_ += sizeOf(type);
    return decode(type, bytes_.data() + place_);
}

Result<double> Body::take(const Property& property) {
    return takeNumber(property.type, property.name);
}

Result<std::uint64_t> Body::takeLength(const Property& property) {
    const Result<double> length = takeNumber(*property.list_count, property.name);
    if (!length) {
        return length.error();
    }
    const double value = length.value();
    if (!(value >= 0.0 && value <= 4294967295.0) || value != std::floor(value)) {
        return failure(name_, place(),
                       fmt::format("the length of list {}, a whole number from 0", printable(property.name)),
                       fmt::format("{}", value));
    }
    return static_cast<std::uint64_t>(value);
}

Status Body::skip(const Property& property) {
    if (!property.list_count) {
        const Result<double> value = takeNumber(property.type, property.name);
        return value ? Status() : Status(value.error());
    }
    const Result<std::uint64_t> length = takeLength(property);
    if (!length) {
        return length.error();
    }
    if (binary_) {
        const std::uint64_t size = length.value() * sizeOf(property.type);
        if (bytes_.size() - at_ < size) {
            return failure(
                name_, atByte(place_),
                fmt::format("a list {} of {} values, {} bytes", printable(property.name), length.value(), size),
                fmt::format("{} bytes to the end of the file", bytes_.size() - at_), "the file is cut short");
        }
        at_ += size;
        return {};
    }
    for (std::uint64_t i = 0; i < length.value(); ++i) {
        if (const Result<double> value = takeText(property.type, property.name); !value) {
            return value.error();
        }
    }
    return {};
}

Status Body::endInstance() {
    ++instance_;
    std::string_view word = binary_ ? std::string_view() : nextWord(rest_);
    if (!word.empty()) {
        return failure(name_, place(), fmt::format("the end of the line after {} {}", element_->name, instance_ - 1),
                       printable(word), "one line holds one element, as the header declares it");
    }
    return {};
}

Status Body::end() {
    if (binary_) {
        if (at_ != bytes_.size()) {
            return failure(name_, atByte(at_), "the end of the file after the last element",
                           fmt::format("{} more bytes", bytes_.size() - at_),
                           "the header's counts or types do not match the data");
        }
        return {};
    }
    while (const std::optional<Line> line = nextLine(asText(bytes_), at_)) {
        at_ = line->next;
        ++line_;
        std::string_view text = line->text;
        if (const std::string_view word = nextWord(text); !word.empty()) {
            return failure(name_, atLine(line_), "the end of the file after the last element", printable(line->text),
                           "the header's counts do not match the data");
        }
    }
    return {};
}

}  // namespace sluice::particles::ply
