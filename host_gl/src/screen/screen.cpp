// SPDX-License-Identifier: MIT
#include "sluice/host_gl/screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "screen/gl_guards.hpp"

namespace sluice::host {
namespace {

struct Limit {
    const char* name;
    GLint value;
};

/// The tightest of the limits that apply, because any of them may be the smaller on a given driver.
Limit sizeLimit() {
    GLint texture = 0;
    GLint renderbuffer = 0;
    std::array<GLint, 2> viewport{};
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &renderbuffer);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
    return std::min({Limit{"GL_MAX_TEXTURE_SIZE", texture}, Limit{"GL_MAX_RENDERBUFFER_SIZE", renderbuffer},
                     Limit{"GL_MAX_VIEWPORT_DIMS", std::min(viewport[0], viewport[1])}},
                    [](const Limit& a, const Limit& b) { return a.value < b.value; });
}

std::uint32_t makeStorage(GLenum format, GLsizei width, GLsizei height) {
    GLuint name = 0;
    glGenRenderbuffers(1, &name);
    glBindRenderbuffer(GL_RENDERBUFFER, name);
    glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
    return name;
}

}  // namespace

Result<Screen> Screen::create(std::uint32_t width, std::uint32_t height) {
    const std::string thing = fmt::format("screen of {}x{} pixels", width, height);
    if (epoxy_gl_version() < 30 && !epoxy_has_gl_extension("GL_ARB_framebuffer_object")) {
        return Error{SLUICE_ERROR_UNSUPPORTED, thing, "GL_ARB_framebuffer_object is missing", "update the GL driver"};
    }
    if (width == 0 || height == 0) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, thing, "width and height must be at least 1", "give a larger size"};
    }
    const Limit limit = sizeLimit();
    if (std::max(width, height) > static_cast<std::uint32_t>(limit.value)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, thing, fmt::format("{} is {}", limit.name, limit.value),
                     fmt::format("give a size of at most {0}x{0}", limit.value)};
    }
    clearGlErrors();
    const FramebufferGuard guard;
    Screen screen;
    screen.width_ = width;
    screen.height_ = height;
    const auto columns = static_cast<GLsizei>(width);
    const auto rows = static_cast<GLsizei>(height);
    screen.colour_ = makeStorage(GL_RGBA8, columns, rows);
    screen.depth_ = makeStorage(GL_DEPTH24_STENCIL8, columns, rows);
    glGenFramebuffers(1, &screen.framebuffer_);
    glBindFramebuffer(GL_FRAMEBUFFER, screen.framebuffer_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, screen.colour_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, screen.depth_);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    const GLenum error = glGetError();
    if (error == GL_OUT_OF_MEMORY) {
        return Error{SLUICE_ERROR_OUT_OF_MEMORY, thing, "the driver is out of memory (GL_OUT_OF_MEMORY)",
                     "give a smaller size"};
    }
    if (status != GL_FRAMEBUFFER_COMPLETE || error != GL_NO_ERROR) {
        return Error{
            SLUICE_ERROR_UNSUPPORTED, thing,
            fmt::format("RGBA8 with DEPTH24_STENCIL8 is not complete: status 0x{:04x}, error 0x{:04x}", status, error),
            "update the GL driver"};
    }
    return screen;
}

Screen Screen::borrowed(std::uint32_t framebuffer, std::uint32_t width, std::uint32_t height) {
    Screen screen;
    screen.framebuffer_ = framebuffer;
    screen.width_ = width;
    screen.height_ = height;
    return screen;
}

Screen::Screen(Screen&& other) noexcept
    : framebuffer_(std::exchange(other.framebuffer_, 0)),
      colour_(std::exchange(other.colour_, 0)),
      depth_(std::exchange(other.depth_, 0)),
      width_(std::exchange(other.width_, 0)),
      height_(std::exchange(other.height_, 0)) {}

Screen& Screen::operator=(Screen&& other) noexcept {
    std::swap(framebuffer_, other.framebuffer_);
    std::swap(colour_, other.colour_);
    std::swap(depth_, other.depth_);
    std::swap(width_, other.width_);
    std::swap(height_, other.height_);
    return *this;
}

Screen::~Screen() {
    if (colour_ == 0) {
        return;  // borrowed, or moved from
    }
    if (framebuffer_ != 0) {
        glDeleteFramebuffers(1, &framebuffer_);
    }
    const std::array<GLuint, 2> storage{colour_, depth_};
    glDeleteRenderbuffers(2, storage.data());
}

void Screen::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glViewport(0, 0, static_cast<GLsizei>(width_), static_cast<GLsizei>(height_));
}

}  // namespace sluice::host
