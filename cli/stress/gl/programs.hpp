// SPDX-License-Identifier: MIT
// The programs that compute a turn in OpenGL; cli/stress/chain.hpp says what they compute.
#pragma once

#include <cstdint>

#include "sluice/result.hpp"
#include "stress/options.hpp"

namespace sluice::stress {

/// Owns a linked program: a full-screen one for images, a compute one for buffers. Freed with the context current.
class TurnProgram {
  public:
    TurnProgram() = default;
    [[nodiscard]] static Result<TurnProgram> create(Resource resource);
    TurnProgram(TurnProgram&& other) noexcept;
    TurnProgram& operator=(TurnProgram&& other) noexcept;
    TurnProgram(const TurnProgram&) = delete;
    TurnProgram& operator=(const TurnProgram&) = delete;
    ~TurnProgram();

    [[nodiscard]] std::uint32_t name() const { return program_; }
    /// Makes it current, with the numbers of a turn.
    void use(std::uint32_t salt, std::uint32_t inputs, std::uint32_t width, std::uint32_t texels) const;

  private:
    std::uint32_t program_ = 0;
    std::int32_t salt_ = -1, inputs_ = -1, width_ = -1, texels_ = -1;
};

}  // namespace sluice::stress
