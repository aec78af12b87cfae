// SPDX-License-Identifier: MIT
// Memory that two processes share and that neither can take away under the other.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>

#include "sluice/fd.hpp"
#include "sluice/result.hpp"

namespace sluice::isolate {

/// Owns a mapping. Move-only.
class Mapping {
  public:
    Mapping() = default;
    Mapping(void* at, std::size_t size) : at_(at), size_(size) {}
    Mapping(Mapping&& other) noexcept;
    Mapping& operator=(Mapping&& other) noexcept;
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;
    ~Mapping();

    [[nodiscard]] void* at() const { return at_; }
    [[nodiscard]] std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(at_), size_}; }

  private:
    void* at_ = nullptr;
    std::size_t size_ = 0;
};

/// The parts one after another in memory that nobody can change or resize any more.
[[nodiscard]] Result<UniqueFd> sealedCopy(std::span<const std::span<const std::byte>> parts);
[[nodiscard]] inline Result<UniqueFd> sealedCopy(std::initializer_list<std::span<const std::byte>> parts) {
    return sealedCopy(std::span(parts.begin(), parts.size()));
}
/// Maps such a copy for reading. Refused: memory of another size, and memory that could still shrink (a read of it
/// could then end this process with SIGBUS) or change while it is read.
[[nodiscard]] Result<Mapping> mapSealed(const UniqueFd& fd, std::size_t size);

/// Zeroed memory of `size` bytes that both sides may write and none may resize.
[[nodiscard]] Result<UniqueFd> sharedPage(std::size_t size);
[[nodiscard]] Result<Mapping> mapShared(const UniqueFd& fd, std::size_t size);

}  // namespace sluice::isolate
