// SPDX-License-Identifier: MIT
// A small GLSL program, the same in every profile.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

#include "sluice/result.hpp"

namespace sluice::host {

/// Owns a linked program. Move-only; freed with the GL context current.
class GlProgram {
  public:
    GlProgram() = default;
    /// `name` is what errors call it. The source has no #version: it is compiled as GLSL 1.20, or 1.40 where the
    /// context has no fixed function; it writes FRAGMENT and samples with SAMPLE. The vertex shader is that of every
    /// full-screen pass. Leaves the current program as found.
    [[nodiscard]] static Result<GlProgram> create(std::string_view name, std::string_view fragment_source);
    GlProgram(GlProgram&& other) noexcept : program_(std::exchange(other.program_, 0)) {}
    GlProgram& operator=(GlProgram&& other) noexcept {
        std::swap(program_, other.program_);
        return *this;
    }
    GlProgram(const GlProgram&) = delete;
    GlProgram& operator=(const GlProgram&) = delete;
    ~GlProgram();

    [[nodiscard]] std::uint32_t name() const { return program_; }
    [[nodiscard]] std::int32_t uniform(const char* name) const;

  private:
    std::uint32_t program_ = 0;
};

/// One triangle that covers the viewport. In immediate mode it needs no vertex array, no buffer and no matrix of the
/// host's, and leaves no current attribute behind; without fixed function an empty vertex array of its own.
void drawScreenTriangle();

}  // namespace sluice::host
