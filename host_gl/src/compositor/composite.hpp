// SPDX-License-Identifier: MIT
// Drawing the fluid into the host's frame.
#pragma once

#include <cstdint>

#include "compositor/gl_program.hpp"
#include "sluice/result.hpp"

namespace sluice::host {

/// One full-screen pass. Move-only through its program.
class Compositor {
  public:
    [[nodiscard]] static Result<Compositor> create();

    /// Draws `colour` (sRGB-encoded, not premultiplied, alpha = coverage) where coverage is above 0 and `depth` (window
    /// depth) is less than or equal to the framebuffer's, writing that depth. Both textures are width x height with
    /// GL_NEAREST filters and one level; texel (x, y) lands on pixel (x, y). Colour c over the screen's s gives
    /// c a + s (1 - a); the screen's alpha t becomes a + t (1 - a), so that an opaque screen stays opaque. Leaves all
    /// GL state as found.
    void draw(std::uint32_t framebuffer, std::uint32_t width, std::uint32_t height, std::uint32_t colour,
              std::uint32_t depth) const;

  private:
    GlProgram program_;
    std::int32_t texel_ = -1, colour_ = -1, depth_ = -1;
};

}  // namespace sluice::host
