// SPDX-License-Identifier: MIT
#include "reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>

#include "nearest.hpp"

namespace sluice::scene {
namespace {

/// nlohmann's messages start with "[json.exception...] "; the rest says line, column and what was found.
/// They quote the whole of a bad token, however long, so the middle is left out of a long one.
std::string withoutTag(const std::string& message) {
    constexpr std::size_t kHead = 160;
    constexpr std::size_t kTail = 80;
    const std::size_t end = message.find("] ");
    std::string text = end == std::string::npos ? message : message.substr(end + 2);
    if (text.size() <= kHead + kTail) {
        return text;
    }
    return text.substr(0, kHead) + " ... " + text.substr(text.size() - kTail);
}

/// A value as the file has it, shortened so that a message stays one line.
std::string shown(const nlohmann::json& value) {
    constexpr std::size_t kLongest = 40;
    if (value.is_object()) {
        return "an object";
    }
    if (value.is_array() && value.size() > 4) {
        return fmt::format("a list of {}", value.size());
    }
    std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    if (text.size() > kLongest) {
        text = text.substr(0, kLongest - 3) + "...";
    }
    return text;
}

/// A key as the file has it, escaped and shortened likewise.
std::string shownKey(const std::string& key) {
    constexpr std::size_t kLongest = 60;
    const std::string quoted = nlohmann::json(key).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    const std::string text = quoted.substr(1, quoted.size() - 2);
    return text.size() > kLongest ? text.substr(0, kLongest - 3) + "..." : text;
}

}  // namespace

Result<nlohmann::json> parseObject(std::string_view text, const std::string& name, const char* remedy) {
    nlohmann::json document;
    try {
        document = nlohmann::json::parse(text.begin(), text.end(), nullptr, true, true);
    } catch (const std::exception& failure) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, name,
                     fmt::format("not a JSON document: {}", withoutTag(failure.what())), remedy};
    }
    if (!document.is_object()) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, name,
                     fmt::format("expected a JSON object, found a JSON {}", document.type_name()), remedy};
    }
    return document;
}

std::string Range::text(const char* what) const {
    if (low_open && high >= 1.0e6) {
        return fmt::format("{} > {} and at most {}", what, low, high);
    }
    return fmt::format("{} in {}{}, {}]", what, low_open ? "(" : "[", low, high);
}

ObjectReader::ObjectReader(const nlohmann::json& object, std::string path, const std::string& name,
                           std::optional<Error>& failure)
    : object_(object), path_(std::move(path)), name_(name), failure_(failure) {}

const nlohmann::json* ObjectReader::find(std::string_view key) {
    known_.push_back(key);
    if (failure_) {
        return nullptr;
    }
    const auto found = object_.find(std::string(key));
    return found == object_.end() ? nullptr : &*found;
}

bool ObjectReader::require(bool good, const std::string& path, const nlohmann::json& value,
                           const std::string& expected) {
    if (!good && !failure_) {
        failure_ = Error{SLUICE_ERROR_INVALID_ARGUMENT, name_,
                         fmt::format("{}: expected {}, found {}", path, expected, shown(value)), ""};
    }
    return good;
}

void ObjectReader::fail(std::string_view key, const std::string& expected, const std::string& found) {
    if (!failure_) {
        failure_ = Error{SLUICE_ERROR_INVALID_ARGUMENT, name_,
                         fmt::format("{}: expected {}, found {}", at(key), expected, found), ""};
    }
}

void ObjectReader::text(std::string_view key, std::string& out) {
    const nlohmann::json* value = find(key);
    if (value != nullptr && require(value->is_string(), at(key), *value, "a string")) {
        out = value->get<std::string>();
    }
}

void ObjectReader::number(std::string_view key, float& out, const Range& range) {
    const nlohmann::json* value = find(key);
    if (value != nullptr &&
        require(value->is_number() && range.holds(value->get<double>()), at(key), *value, range.text("a number"))) {
        out = value->get<float>();
    }
}

void ObjectReader::integer(std::string_view key, std::uint32_t& out, std::uint32_t low, std::uint32_t high) {
    const nlohmann::json* value = find(key);
    const Range range{static_cast<double>(low), static_cast<double>(high)};
    if (value != nullptr && require(value->is_number_integer() && range.holds(value->get<double>()), at(key), *value,
                                    range.text("a whole number"))) {
        out = value->get<std::uint32_t>();
    }
}

void ObjectReader::flag(std::string_view key, std::uint32_t& out) {
    const nlohmann::json* value = find(key);
    if (value != nullptr && require(value->is_boolean(), at(key), *value, "true or false")) {
        out = value->get<bool>() ? 1 : 0;
    }
}

void ObjectReader::choice(std::string_view key, std::uint32_t& out, std::span<const Choice> choices) {
    const nlohmann::json* value = find(key);
    if (value == nullptr) {
        return;
    }
    std::vector<std::string> names;
    for (const Choice& choice : choices) {
        if (value->is_string() && value->get_ref<const std::string&>() == choice.first) {
            out = choice.second;
            return;
        }
        names.push_back(fmt::format("\"{}\"", choice.first));
    }
    require(false, at(key), *value, fmt::format("one of {}", fmt::join(names, ", ")));
}

void ObjectReader::numbers(std::string_view key, std::span<float, 3> out, const Range& range) {
    const nlohmann::json* value = find(key);
    if (value == nullptr || !require(value->is_array() && value->size() == 3, at(key), *value, "a list of 3 numbers")) {
        return;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const nlohmann::json& item = (*value)[i];
        if (!require(item.is_number() && range.holds(item.get<double>()), at(key) + "/" + std::to_string(i), item,
                     range.text("a number"))) {
            return;
        }
        out[i] = item.get<float>();
    }
}

void ObjectReader::numberOf(std::string_view key, float& out, std::span<const float> values) {
    const nlohmann::json* value = find(key);
    if (value == nullptr) {
        return;
    }
    const auto same = [value](float allowed) { return value->is_number() && value->get<float>() == allowed; };
    const auto found = std::find_if(values.begin(), values.end(), same);
    if (require(found != values.end(), at(key), *value, fmt::format("one of {}", fmt::join(values, ", ")))) {
        out = *found;
    }
}

bool ObjectReader::integers(std::string_view key, std::span<std::int64_t, 2> out, std::int64_t low, std::int64_t high) {
    const nlohmann::json* value = find(key);
    if (value == nullptr ||
        !require(value->is_array() && value->size() == 2, at(key), *value, "a list of 2 whole numbers")) {
        return false;
    }
    const Range range{static_cast<double>(low), static_cast<double>(high)};
    for (std::size_t i = 0; i < 2; ++i) {
        const nlohmann::json& item = (*value)[i];
        if (!require(item.is_number_integer() && range.holds(item.get<double>()), at(key) + "/" + std::to_string(i),
                     item, range.text("a whole number"))) {
            return false;
        }
        out[i] = item.get<std::int64_t>();
    }
    return true;
}

void ObjectReader::finish() {
    for (const auto& [key, value] : object_.items()) {
        if (failure_) {
            return;
        }
        if (std::find(known_.begin(), known_.end(), key) != known_.end()) {
            continue;
        }
        const std::string_view guess = nearest(key, known_);
        failure_ = Error{SLUICE_ERROR_INVALID_ARGUMENT, name_,
                         fmt::format("{}: unknown key with value {}{}", at(shownKey(key)), shown(value),
                                     guess.empty() ? "" : fmt::format("; the nearest known key is \"{}\"", guess)),
                         fmt::format("known keys here: {}", fmt::join(known_, ", "))};
    }
}

void ObjectReader::requireAll() {
    std::vector<std::string_view> needed;
    std::copy_if(known_.begin(), known_.end(), std::back_inserter(needed), [this](std::string_view key) {
        return std::find(lacking_.begin(), lacking_.end(), key) == lacking_.end();
    });
    for (const std::string_view key : needed) {
        if (failure_) {
            return;
        }
        if (!object_.contains(std::string(key))) {
            // A misspelt key is both unknown and missing; the unknown one is the more useful message.
            finish();
            if (!failure_) {
                failure_ = Error{SLUICE_ERROR_INVALID_ARGUMENT, name_, fmt::format("{}: missing", at(key)),
                                 fmt::format("every member of this list needs: {}", fmt::join(needed, ", "))};
            }
        }
    }
}

}  // namespace sluice::scene
