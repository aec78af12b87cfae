// SPDX-License-Identifier: MIT
#include "compositor/screen_binding.hpp"

namespace sluice::host {

namespace {

GLenum firstBuffer(GLuint framebuffer) {
    return framebuffer != 0 ? GL_COLOR_ATTACHMENT0 : GL_BACK;
}

}  // namespace

ReadBinding::ReadBinding(GLuint framebuffer) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glGetIntegerv(GL_READ_BUFFER, &read_buffer_);
    glReadBuffer(firstBuffer(framebuffer));
}

ReadBinding::~ReadBinding() {
    glReadBuffer(static_cast<GLenum>(read_buffer_));
}

DrawBinding::DrawBinding(GLuint framebuffer) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    GLint count = 1;
    glGetIntegerv(GL_MAX_DRAW_BUFFERS, &count);
    for (GLint i = 0; i < count; ++i) {
        GLint buffer = GL_NONE;
        glGetIntegerv(GL_DRAW_BUFFER0 + static_cast<GLenum>(i), &buffer);
        draw_buffers_.push_back(static_cast<GLenum>(buffer));
    }
    glDrawBuffer(firstBuffer(framebuffer));
}

DrawBinding::~DrawBinding() {
    // Names such as GL_BACK or GL_FRONT_AND_BACK, which only framebuffer 0 has, are not accepted by glDrawBuffers.
    bool several = false;
    for (std::size_t i = 1; i < draw_buffers_.size(); ++i) {
        several = several || draw_buffers_[i] != GL_NONE;
    }
    if (several) {
        glDrawBuffers(static_cast<GLsizei>(draw_buffers_.size()), draw_buffers_.data());
    } else {
        glDrawBuffer(draw_buffers_.front());
    }
}

}  // namespace sluice::host
