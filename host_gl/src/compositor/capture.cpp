// SPDX-License-Identifier: MIT
#include "compositor/capture.hpp"

#include <epoxy/gl.h>

#include "compositor/screen_binding.hpp"
#include "screen/gl_guards.hpp"

namespace sluice::host {

void captureScreen(std::uint32_t framebuffer, std::uint32_t width, std::uint32_t height, std::uint32_t colour,
                   std::uint32_t depth) {
    // Pixel transfer (scale, bias, maps) applies to copies as well, hence the guard.
    const PixelGuard pixels;
    const TextureGuard binding;
    const ReadBinding source(framebuffer);
    for (const std::uint32_t texture : {colour, depth}) {
        if (texture != 0) {
            // Colour or depth is read according to the texture's own base format. Not glBlitFramebuffer: that cannot
            // convert 24-bit depth to 32-bit float.
            glBindTexture(GL_TEXTURE_2D, texture);
            glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, static_cast<GLsizei>(width),
                                static_cast<GLsizei>(height));
        }
    }
}

}  // namespace sluice::host
