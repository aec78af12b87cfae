// SPDX-License-Identifier: MIT
// Expected failure as a value: an error that names the thing, the value and the remedy.
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

#include "sluice/plugin.h"

namespace sluice {

/// One expected failure, told to a person: "<thing>: <detail> (<remedy>)".
struct Error {
    SluiceResult code = SLUICE_ERROR_INTERNAL;
    std::string thing;   ///< what failed: a file, a format, an extension
    std::string detail;  ///< expected and found
    std::string remedy;  ///< what the reader can do about it; may be empty

    [[nodiscard]] std::string message() const {
        std::string text = thing.empty() ? detail : thing + ": " + detail;
        if (!remedy.empty()) {
            text += " (" + remedy + ")";
        }
        return text;
    }
};

/// A value or an Error. Reading the wrong one is a broken contract and asserts.
template <typename T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    [[nodiscard]] T& value() & {
        assert(ok());
        return *std::get_if<0>(&state_);
    }
    [[nodiscard]] const T& value() const& {
        assert(ok());
        return *std::get_if<0>(&state_);
    }
    [[nodiscard]] T&& value() && {
        assert(ok());
        return std::move(*std::get_if<0>(&state_));
    }
    [[nodiscard]] const Error& error() const {
        assert(!ok());
        return *std::get_if<1>(&state_);
    }

  private:
    std::variant<T, Error> state_;
};

/// Success without a value, or an Error.
template <>
class [[nodiscard]] Result<void> {
  public:
    Result() = default;
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }
    [[nodiscard]] const Error& error() const {
        assert(!ok());
        return *std::get_if<1>(&state_);
    }

  private:
    std::variant<std::monostate, Error> state_;
};

using Status = Result<void>;

}  // namespace sluice
