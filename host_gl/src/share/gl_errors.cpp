// SPDX-License-Identifier: MIT
#include "share/gl_errors.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

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

}  // namespace

std::string takeGlErrors() {
    std::string names;
    for (int i = 0; i < kMostErrors; ++i) {
        const GLenum error = glGetError();
        if (error == GL_NO_ERROR) {
            break;
        }
        names += fmt::format("{}{} (0x{:04x})", names.empty() ? "" : ", ", nameOf(error), error);
    }
    return names;
}

}  // namespace sluice::host
