// SPDX-License-Identifier: MIT
#include "share/gl_errors.hpp"

#include <fmt/format.h>

#include "screen/gl_guards.hpp"

namespace sluice::host {

namespace {

// A lost context may report its error for ever.
constexpr int kMostErrors = 16;

const char* nameOf(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY";
        case GL_CONTEXT_LOST:
            return "GL_CONTEXT_LOST";
        default:
            return "unknown GL error";
    }
}

std::vector<GLenum> takeErrors() {
    std::vector<GLenum> errors;
    for (int i = 0; i < kMostErrors; ++i) {
        const GLenum error = glGetError();
        if (error == GL_NO_ERROR) {
            break;
        }
        errors.push_back(error);
    }
    return errors;
}

/// A framebuffer without attachments is incomplete, and so refuses to be read.
void raiseFramebufferError() {
    const FramebufferGuard guard;
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    GLubyte texel[4]{};
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &texel[0]);
    glDeleteFramebuffers(1, &framebuffer);
}

void raise(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM:
            glEnable(GL_NONE);
            break;
        case GL_INVALID_VALUE:
            glClear(~GLbitfield{0});
            break;
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            raiseFramebufferError();
            break;
        default:
            glBeginQuery(GL_SAMPLES_PASSED, 0);  // zero is never the name of a query
            break;
    }
}

}  // namespace

std::string takeGlErrors() {
    std::string names;
    for (const GLenum error : takeErrors()) {
        names += fmt::format("{}{} (0x{:04x})", names.empty() ? "" : ", ", nameOf(error), error);
    }
    return names;
}

GlErrorScope::GlErrorScope() : found_(takeErrors()) {}

GlErrorScope::~GlErrorScope() {
    clearGlErrors();
    for (const GLenum error : found_) {
        raise(error);
    }
}

}  // namespace sluice::host
