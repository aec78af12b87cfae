// SPDX-License-Identifier: MIT
// What stands in for the legacy engine's back buffer, and reading it for output files.
#pragma once

#include <cstdint>
#include <vector>

#include "sluice/result.hpp"
#include "sluice/trace.hpp"

namespace sluice::host {

/// A framebuffer of RGBA8 colour and 24-bit depth with 8-bit stencil, as an engine of 2004 would ask for; or a host's
/// own.
class Screen {
  public:
    [[nodiscard]] static Result<Screen> create(std::uint32_t width, std::uint32_t height);
    /// The lower left of a framebuffer that somebody else owns and keeps, 0 for the window's: its draw buffer 0, or its
    /// first buffer if that is deselected, and its depth.
    [[nodiscard]] static Screen borrowed(std::uint32_t framebuffer, std::uint32_t width, std::uint32_t height);
    Screen(Screen&&) noexcept;
    Screen& operator=(Screen&&) noexcept;
    ~Screen();

    void bind() const;  ///< as the draw and read framebuffer, with its viewport
    [[nodiscard]] std::uint32_t framebuffer() const { return framebuffer_; }
    [[nodiscard]] std::uint32_t width() const { return width_; }
    [[nodiscard]] std::uint32_t height() const { return height_; }

  private:
    Screen() = default;
    std::uint32_t framebuffer_ = 0, colour_ = 0, depth_ = 0, width_ = 0, height_ = 0;
};

/// Pixels on the CPU, rows from the TOP down (as image files have them), channels interleaved.
struct Pixels {
    std::uint32_t width = 0, height = 0, channels = 0;
    std::vector<float> values;
};

/// For output files and tests only, never in the frame loop; recorded as CPU_COPY in `trace` if given.
[[nodiscard]] Pixels readColour(const Screen& screen, Trace* trace);
[[nodiscard]] Pixels readDepth(const Screen& screen, Trace* trace);
/// All channels of a 2-D texture of the given format.
[[nodiscard]] Pixels readTexture(std::uint32_t texture, SluiceFormat format, std::uint32_t width, std::uint32_t height,
                                 Trace* trace);

}  // namespace sluice::host
