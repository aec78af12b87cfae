// SPDX-License-Identifier: MIT
// Fields to bytes and back. Both ends run on one machine, so numbers keep its byte order.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "sluice/abi_sizes.hpp"
#include "sluice/isolate/messages.hpp"

namespace sluice::isolate {

/// Appends fields.
class Writer {
  public:
    template <typename T>
    void number(const T& value) {
        static_assert(std::is_arithmetic_v<T>);
        raw(&value, sizeof(value));
    }
    void result(std::int32_t value) { number(value); }
    void text(const std::string& text) {
        const std::size_t length = std::min(text.size(), kMaxText);
        number(static_cast<std::uint32_t>(length));
        raw(text.data(), length);
    }
    void name(const std::array<char, 32>& name) { raw(name.data(), name.size()); }
    /// Says the size first, so that a reader of another minor version knows what is missing.
    template <typename T>
    void abi(const T& value) {
        number(static_cast<std::uint32_t>(sizeof(T)));
        const std::size_t at = bytes_.size();
        raw(&value, sizeof(value));
        const std::uint32_t size = sizeof(T);  // the first field
        std::memcpy(&bytes_[at], &size, sizeof(size));
    }
    template <typename... T>
    void filled(const std::variant<std::monostate, T...>& value) {
        number(static_cast<std::uint32_t>(value.index()));
        std::visit(
            [&](const auto& held) {
                if constexpr (!std::is_same_v<std::decay_t<decltype(held)>, std::monostate>) {
                    abi(held);
                }
            },
            value);
    }
    template <typename T, typename Each>
    void list(const std::vector<T>& items, std::size_t most, Each each) {
        const std::size_t count = std::min(items.size(), most);
        number(static_cast<std::uint32_t>(count));
        for (std::size_t i = 0; i < count; ++i) {
            each(*this, items[i]);
        }
    }
    [[nodiscard]] std::vector<std::byte>& bytes() { return bytes_; }

  private:
    void raw(const void* from, std::size_t size) {
        const auto* begin = static_cast<const std::byte*>(from);
        bytes_.insert(bytes_.end(), begin, begin + size);
    }
    std::vector<std::byte> bytes_;
};

/// Takes fields off the front. The first failure stays; after it every field is zero.
class Reader {
  public:
    Reader(std::span<const std::byte> bytes, std::string_view kind, std::size_t offset)
        : bytes_(bytes), kind_(kind), at_(offset) {}

    template <typename T>
    void number(T& value) {
        static_assert(std::is_arithmetic_v<T>);
        value = T{};
        take(&value, sizeof(value));
    }
    void result(std::int32_t& value) {
        const std::size_t at = at_;
        number(value);
        if (value < SLUICE_ERROR_INTERNAL || value > SLUICE_TIMEOUT) {
            fail(at, "a SluiceResult", std::to_string(value));
            value = SLUICE_ERROR_INTERNAL;
        }
    }
    void text(std::string& text) {
        const std::size_t at = at_;
        std::uint32_t length = 0;
        number(length);
        if (length > kMaxText) {
            fail(at, "a text of at most " + std::to_string(kMaxText) + " bytes", std::to_string(length));
            return;
        }
        text.resize(ok() && length <= left() ? length : 0);
        take(text.data(), length);
        // What is read as a C string must not end early on one side only.
        if (text.find('\0') != std::string::npos) {
            fail(at, "a text without a zero byte", "one");
        }
    }
    void name(std::array<char, 32>& name) {
        take(name.data(), name.size());
        name.back() = '\0';
    }
    template <typename T>
    void abi(T& value) {
        const std::size_t at = at_;
        std::uint32_t size = 0;
        number(size);
        if (ok() && (size < kAbiMinimum<T> || size > left())) {
            fail(at, "a struct of " + std::to_string(kAbiMinimum<T>) + " to " + std::to_string(left()) + " bytes",
                 std::to_string(size));
        }
        if (!ok()) {
            return;
        }
        value = T{};
        std::memcpy(&value, &bytes_[at_], std::min<std::size_t>(size, sizeof(T)));
        value.struct_size = sizeof(T);
        at_ += size;
        check(value, at);
    }
    template <typename... T>
    void filled(std::variant<std::monostate, T...>& value) {
        const std::size_t at = at_;
        std::uint32_t index = 0;
        number(index);
        if (index > sizeof...(T)) {
            fail(at, "0 to " + std::to_string(sizeof...(T)) + " for what was filled", std::to_string(index));
        }
        if (ok()) {
            fillAt<0, T...>(value, index);
        }
    }
    template <typename T, typename Each>
    void list(std::vector<T>& items, std::size_t most, Each each) {
        const std::size_t at = at_;
        std::uint32_t count = 0;
        number(count);
        if (count > most) {
            fail(at, "a list of at most " + std::to_string(most), std::to_string(count));
        }
        for (std::uint32_t i = 0; ok() && i < count; ++i) {
            each(*this, items.emplace_back());
        }
    }

    /// Everything was read, and nothing is left.
    [[nodiscard]] Status finish() {
        if (ok() && left() != 0) {
            fail(at_, "the end of the message", std::to_string(left()) + " bytes more");
        }
        return ok() ? Status{} : Status{error_};
    }
    [[nodiscard]] bool ok() const { return error_.thing.empty(); }

  private:
    [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
    void take(void* to, std::size_t size) {
        if (ok() && size > left()) {
            fail(at_, std::to_string(size) + " bytes", std::to_string(left()));
        }
        if (!ok() || size == 0) {
            return;
        }
        std::memcpy(to, &bytes_[at_], size);
        at_ += size;
    }
    void fail(std::size_t at, std::string expected, std::string found) {
        if (ok()) {
            error_ = Error{
                SLUICE_ERROR_INVALID_ARGUMENT, "message " + std::string(kind_),
                "at byte " + std::to_string(at) + ": expected " + std::move(expected) + ", found " + std::move(found),
                "the two processes are not of one release, or the other one is broken"};
        }
    }
    template <std::size_t N, typename First, typename... Rest, typename Variant>
    void fillAt(Variant& value, std::uint32_t index) {
        if (index == N + 1) {
            abi(value.template emplace<N + 1>(First{}));
        } else if constexpr (sizeof...(Rest) > 0) {
            fillAt<N + 1, Rest...>(value, index);
        }
    }
    template <typename T>
    void check(T& /*value*/, std::size_t /*at*/) {}
    void check(SluiceRendererCapabilities& value, std::size_t /*at*/) { end(value); }
    void check(SluiceRendererInfo& value, std::size_t /*at*/) { end(value.capabilities); }
    void check(SluiceFrameStats& value, std::size_t at) {
        if (value.pass_count > SLUICE_MAX_PASSES) {
            fail(at, "at most " + std::to_string(SLUICE_MAX_PASSES) + " passes", std::to_string(value.pass_count));
        }
        for (SluicePassStats& pass : value.passes) {
            pass.name[sizeof(pass.name) - 1] = '\0';
        }
    }
    void check(SluiceSimulationStats& value, std::size_t /*at*/) { value.message[sizeof(value.message) - 1] = '\0'; }
    void check(SluiceBodies& value, std::size_t at) {
        if (value.count > SLUICE_MAX_BODIES) {
            fail(at, "at most " + std::to_string(SLUICE_MAX_BODIES) + " bodies", std::to_string(value.count));
        }
    }
    static void end(SluiceRendererCapabilities& value) {
        value.device_name[sizeof(value.device_name) - 1] = '\0';
        value.driver_name[sizeof(value.driver_name) - 1] = '\0';
        value.driver_info[sizeof(value.driver_info) - 1] = '\0';
    }

    std::span<const std::byte> bytes_;
    std::string_view kind_;
    std::size_t at_;
    Error error_;
};

}  // namespace sluice::isolate
