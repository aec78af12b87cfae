// SPDX-License-Identifier: MIT
#include "compositor/screen_binding.hpp"

namespace sluice::host {

namespace {

/// Where the framebuffer that is bound for drawing is drawn to, or would be had its owner not deselected its buffers.
GLenum firstBuffer(GLuint framebuffer) {
    GLint selected = GL_NONE;
    glGetIntegerv(GL_DRAW_BUFFER0, &selected);
    if (selected != GL_NONE) {
        return static_cast<GLenum>(selected);
    }
    if (framebuffer != 0) {
        return GL_COLOR_ATTACHMENT0;
    }
    GLboolean two = GL_TRUE;
    glGetBooleanv(GL_DOUBLEBUFFER, &two);
    return two == GL_TRUE ? GL_BACK : GL_FRONT;
}

/// Several of the window's buffers at once can be drawn to and not be read.
GLenum readable(GLenum buffer) {
    switch (buffer) {
        case GL_FRONT_AND_BACK:
        case GL_LEFT:
        case GL_RIGHT:
            return GL_FRONT;
        default:
            return buffer;
    }
}

}  // namespace

ReadBinding::ReadBinding(GLuint framebuffer) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glGetIntegerv(GL_READ_BUFFER, &read_buffer_);
    glReadBuffer(readable(firstBuffer(framebuffer)));
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
