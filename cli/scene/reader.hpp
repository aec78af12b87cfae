// SPDX-License-Identifier: MIT
// The visitor that reads a JSON object into fields, and says exactly what is wrong with the first bad one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fields.hpp"
#include "limits.hpp"
#include "sluice/result.hpp"

namespace sluice::scene {

/// A file's text, with comments or without, as one object; the error has line and column.
[[nodiscard]] Result<nlohmann::json> parseObject(std::string_view text, const std::string& name, const char* remedy);

/// Reads one JSON object. All readers of a document share `failure`; after the first failure they do nothing.
/// Absent keys leave their field as it was, so the field's initial value is its default.
class ObjectReader {
  public:
    ObjectReader(const nlohmann::json& object, std::string path, const std::string& name,
                 std::optional<Error>& failure);

    void text(std::string_view key, std::string& out);
    void number(std::string_view key, float& out, const Range& range);
    void integer(std::string_view key, std::uint32_t& out, std::uint32_t low, std::uint32_t high);
    void flag(std::string_view key, std::uint32_t& out);
    void choice(std::string_view key, std::uint32_t& out, std::span<const Choice> choices);
    void numbers(std::string_view key, std::span<float, 3> out, const Range& range);
    void numberOf(std::string_view key, float& out, std::span<const float> values);

    /// Two integers [a, b], both within low..high.
    template <typename Integer>
    void pair(std::string_view key, Integer& a, Integer& b, std::int64_t low, std::int64_t high) {
        std::array<std::int64_t, 2> values{};
        if (integers(key, values, low, high)) {
            a = static_cast<Integer>(values[0]);
            b = static_cast<Integer>(values[1]);
        }
    }
    template <typename Visit>
    void object(std::string_view key, const Visit& visit) {
        const nlohmann::json* value = find(key);
        if (value != nullptr && require(value->is_object(), at(key), *value, "an object")) {
            ObjectReader inner(*value, at(key), name_, failure_);
            visit(inner);
            inner.finish();
        }
    }
    template <typename T, typename Visit>
    void list(std::string_view key, std::vector<T>& out, const Visit& visit) {
        const nlohmann::json* value = find(key);
        if (value == nullptr || !require(value->is_array(), at(key), *value, "a list of objects")) {
            return;
        }
        out.clear();
        for (std::size_t i = 0; i < value->size() && !failure_; ++i) {
            const std::string path = at(key) + "/" + std::to_string(i);
            if (require((*value)[i].is_object(), path, (*value)[i], "an object")) {
                ObjectReader inner((*value)[i], path, name_, failure_);
                visit(inner, out.emplace_back(T{}));
                inner.requireAll();
                inner.finish();
            }
        }
    }

    /// To be called after all fields: any key that nobody asked for is an error.
    void finish();
    /// Of a member of a list: this key has a default after all.
    void mayLack(std::string_view key) { lacking_.push_back(key); }
    /// Members of lists have no defaults: every other key must be there.
    void requireAll();
    /// Records an error about `key` that needs more than one field to see.
    void fail(std::string_view key, const std::string& expected, const std::string& found);

  private:
    [[nodiscard]] const nlohmann::json* find(std::string_view key);
    [[nodiscard]] std::string at(std::string_view key) const { return path_ + "/" + std::string(key); }
    bool require(bool good, const std::string& path, const nlohmann::json& value, const std::string& expected);
    bool integers(std::string_view key, std::span<std::int64_t, 2> out, std::int64_t low, std::int64_t high);

    const nlohmann::json& object_;
    std::string path_;
    const std::string& name_;
    std::optional<Error>& failure_;
    std::vector<std::string_view> known_, lacking_;
};

}  // namespace sluice::scene
