// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "fields.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::scene {
namespace {

using Json = nlohmann::ordered_json;

/// The double whose shortest text is the float's shortest text: 0.1F is written as 0.1, not as 0.10000000149.
double shortest(float value) {
    return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

/// The visitor that writes fields into a JSON object.
class ObjectWriter {
  public:
    explicit ObjectWriter(Json& object) : object_(object) {}

    void text(std::string_view key, const std::string& value) { put(key, value); }
    void number(std::string_view key, float value, const Range& /*range*/) { put(key, shortest(value)); }
    void integer(std::string_view key, std::uint32_t value, std::uint32_t /*low*/, std::uint32_t /*high*/) {
        put(key, value);
    }
    void flag(std::string_view key, std::uint32_t value) { put(key, value != 0); }
    void choice(std::string_view key, std::uint32_t value, std::span<const Choice> choices) {
        for (const Choice& choice : choices) {
            if (choice.second == value) {
                put(key, std::string(choice.first));
            }
        }
    }
    void numbers(std::string_view key, std::span<const float, 3> value, const Range& /*range*/) {
        put(key, {shortest(value[0]), shortest(value[1]), shortest(value[2])});
    }
    void numberOf(std::string_view key, float value, std::span<const float> /*values*/) { put(key, shortest(value)); }
    void mayLack(std::string_view /*key*/) {}
    template <typename Integer>
    void pair(std::string_view key, Integer a, Integer b, std::int64_t /*low*/, std::int64_t /*high*/) {
        put(key, {a, b});
    }
    template <typename Visit>
    void object(std::string_view key, const Visit& visit) {
        Json inner = Json::object();
        ObjectWriter writer(inner);
        visit(writer);
        put(key, std::move(inner));
    }
    template <typename T, typename Visit>
    void list(std::string_view key, std::vector<T>& values, const Visit& visit) {
        Json items = Json::array();
        for (T& value : values) {
            Json item = Json::object();
            ObjectWriter writer(item);
            visit(writer, value);
            items.push_back(std::move(item));
        }
        put(key, std::move(items));
    }

  private:
    void put(std::string_view key, Json value) { object_[std::string(key)] = std::move(value); }
    Json& object_;
};

}  // namespace

std::string writeScene(const Scene& scene) {
    Scene copy = scene;  // the visitors take fields by reference, to fill them
    Json document = Json::object();
    ObjectWriter writer(document);
    visitScene(writer, copy);
    return document.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace sluice::scene
