// SPDX-License-Identifier: MIT
// The screen's framebuffer as source or target, with its own buffer selection put back afterwards.
#pragma once

#include <epoxy/gl.h>

#include <vector>

#include "screen/gl_guards.hpp"

namespace sluice::host {

/// Binds `framebuffer` and reads the buffer that its owner draws to first; if that is deselected, its first one.
class ReadBinding {
  public:
    explicit ReadBinding(GLuint framebuffer);
    ~ReadBinding();
    ReadBinding(const ReadBinding&) = delete;
    ReadBinding& operator=(const ReadBinding&) = delete;

  private:
    FramebufferGuard bindings_;  // restored last
    GLint read_buffer_ = 0;
};

/// Binds `framebuffer` to GL_DRAW_FRAMEBUFFER and draws to that same buffer only.
class DrawBinding {
  public:
    explicit DrawBinding(GLuint framebuffer);
    ~DrawBinding();
    DrawBinding(const DrawBinding&) = delete;
    DrawBinding& operator=(const DrawBinding&) = delete;

  private:
    FramebufferGuard bindings_;  // restored last
    std::vector<GLenum> draw_buffers_;
};

}  // namespace sluice::host
