// SPDX-License-Identifier: MIT
#include "api/target.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <utility>

#include "compositor/draw_guard.hpp"
#include "context/profile.hpp"
#include "screen/gl_guards.hpp"
#include "share/gl_errors.hpp"

namespace sluice::host {

namespace {

constexpr const char* kThing = "framebuffer bound for drawing";

GLint attachment(GLenum point, GLenum what) {
    GLint value = 0;
    glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, point, what, &value);
    return value;
}

struct Attached {
    GLenum format = GL_NONE;
    Extent extent{};
};

Attached describeTexture(GLuint name, GLint level, GLenum target, GLenum binding) {
    GLint bound = 0;
    glGetIntegerv(binding, &bound);
    glBindTexture(target, name);
    GLint format = 0;
    GLint width = 0;
    GLint height = 0;
    glGetTexLevelParameteriv(target, level, GL_TEXTURE_INTERNAL_FORMAT, &format);
    glGetTexLevelParameteriv(target, level, GL_TEXTURE_WIDTH, &width);
    glGetTexLevelParameteriv(target, level, GL_TEXTURE_HEIGHT, &height);
    glBindTexture(target, static_cast<GLuint>(bound));
    return {static_cast<GLenum>(format), {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)}};
}

Attached describeRenderbuffer(GLuint name) {
    GLint bound = 0;
    glGetIntegerv(GL_RENDERBUFFER_BINDING, &bound);
    glBindRenderbuffer(GL_RENDERBUFFER, name);
    GLint format = 0;
    GLint width = 0;
    GLint height = 0;
    glGetRenderbufferParameteriv(GL_RENDERBUFFER, GL_RENDERBUFFER_INTERNAL_FORMAT, &format);
    glGetRenderbufferParameteriv(GL_RENDERBUFFER, GL_RENDERBUFFER_WIDTH, &width);
    glGetRenderbufferParameteriv(GL_RENDERBUFFER, GL_RENDERBUFFER_HEIGHT, &height);
    glBindRenderbuffer(GL_RENDERBUFFER, static_cast<GLuint>(bound));
    return {static_cast<GLenum>(format), {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)}};
}

/// What is attached there; format GL_NONE where nothing is.
Attached describe(GLenum point, GLint samples) {
    const GLint type = attachment(point, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE);
    const auto name =
        static_cast<GLuint>(type != GL_NONE ? attachment(point, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME) : 0);
    if (type == GL_RENDERBUFFER) {
        return describeRenderbuffer(name);
    }
    if (type != GL_TEXTURE) {
        return {};
    }
    const GLint level = attachment(point, GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL);
    if (samples > 0) {
        return describeTexture(name, 0, GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_BINDING_2D_MULTISAMPLE);
    }
    return describeTexture(name, level, GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D);
}

GLenum drawBuffer() {
    GLint buffer = GL_NONE;
    glGetIntegerv(GL_DRAW_BUFFER0, &buffer);
    return buffer == GL_NONE ? GL_COLOR_ATTACHMENT0 : static_cast<GLenum>(buffer);
}

Result<Target> windowTarget(Target target) {
    GLint bits = 0;
    // Core profiles took GL_DEPTH_BITS away and brought a query of the framebuffer.
    if (hasFixedFunction()) {
        glGetIntegerv(GL_DEPTH_BITS, &bits);
    } else {
        glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, GL_DEPTH, GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE,
                                              &bits);
    }
    if (bits == 0) {
        return Error{SLUICE_ERROR_UNSUPPORTED, kThing, "the window has no depth buffer",
                     "ask for 24 bits of depth where the window is made"};
    }
    return target;
}

}  // namespace

Result<Target> boundTarget() {
    const GlErrorScope errors;
    Target target;
    GLint name = 0;
    GLint samples = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &name);
    glGetIntegerv(GL_SAMPLES, &samples);
    target.framebuffer = static_cast<std::uint32_t>(name);
    target.samples = static_cast<std::uint32_t>(samples);
    if (const GLenum status = glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER); status != GL_FRAMEBUFFER_COMPLETE) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, kThing,
                     fmt::format("number {} is not complete, status 0x{:04x}", name, status),
                     name == 0 ? "make the context current with a window" : "attach colour and depth"};
    }
    if (name == 0) {
        return windowTarget(target);
    }
    const Attached colour = describe(drawBuffer(), samples);
    const Attached depth = describe(GL_DEPTH_ATTACHMENT, samples);
    const GLint stencil = attachment(GL_STENCIL_ATTACHMENT, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE);
    if (const std::string raised = takeGlErrors(); !raised.empty()) {
        return Error{SLUICE_ERROR_UNSUPPORTED, kThing,
                     fmt::format("number {} could not be looked at, OpenGL raised {}", name, raised),
                     "attach 2-D textures or renderbuffers of one layer"};
    }
    if (colour.format == GL_NONE || depth.format == GL_NONE) {
        return Error{SLUICE_ERROR_UNSUPPORTED, kThing,
                     fmt::format("number {} has no {}", name, colour.format == GL_NONE ? "colour" : "depth"),
                     "call sluice_end_frame while the framebuffer with the world's depth is bound"};
    }
    target.extent = colour.extent;
    target.colour_format = colour.format;
    target.depth_format = depth.format;
    target.stencil = stencil != GL_NONE;
    return target;
}

void Resolve::clear() {
    if (!glGone()) {
        if (framebuffer_ != 0) {
            glDeleteFramebuffers(1, &framebuffer_);
        }
        if (colour_ != 0) {
            const std::array<GLuint, 2> storage{colour_, depth_};
            glDeleteRenderbuffers(2, storage.data());
        }
    }
    framebuffer_ = 0;
    colour_ = 0;
    depth_ = 0;
}

Status Resolve::make(const Target& target, const Extent& extent) {
    if (framebuffer_ != 0 && colour_format_ == target.colour_format && depth_format_ == target.depth_format &&
        extent_ == extent) {
        return {};
    }
    clear();
    const auto width = static_cast<GLsizei>(extent[0]);
    const auto height = static_cast<GLsizei>(extent[1]);
    std::array<GLuint, 2> storage{};
    glGenRenderbuffers(2, storage.data());
    colour_ = storage[0];
    depth_ = storage[1];
    glBindRenderbuffer(GL_RENDERBUFFER, colour_);
    glRenderbufferStorage(GL_RENDERBUFFER, target.colour_format, width, height);
    glBindRenderbuffer(GL_RENDERBUFFER, depth_);
    glRenderbufferStorage(GL_RENDERBUFFER, target.depth_format, width, height);
    glGenFramebuffers(1, &framebuffer_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
    glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
    const bool packed = target.depth_format == GL_DEPTH24_STENCIL8 || target.depth_format == GL_DEPTH32F_STENCIL8 ||
                        target.depth_format == GL_DEPTH_STENCIL;
    glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, packed ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT,
                              GL_RENDERBUFFER, depth_);
    const GLenum status = glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER);
    const std::string raised = takeGlErrors();
    if (status != GL_FRAMEBUFFER_COMPLETE || !raised.empty()) {
        clear();
        return Error{SLUICE_ERROR_UNSUPPORTED, "framebuffer to resolve into",
                     fmt::format("formats 0x{:04x} and 0x{:04x} gave status 0x{:04x}{}{}", target.colour_format,
                                 target.depth_format, status, raised.empty() ? "" : ", OpenGL raised ", raised),
                     "draw the world without samples, or into formats that can be rendered to"};
    }
    colour_format_ = target.colour_format;
    depth_format_ = target.depth_format;
    extent_ = extent;
    return {};
}

Status Resolve::take(const Target& target, const Extent& extent) {
    const GlErrorScope errors;
    const FramebufferGuard bindings;
    if (Status status = make(target, extent); !status) {
        return status;
    }
    const auto width = static_cast<GLsizei>(extent[0]);
    const auto height = static_cast<GLsizei>(extent[1]);
    // A blit minds the scissor, and encodes where GL_FRAMEBUFFER_SRGB is on.
    const DrawGuard state(width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    GLint read_buffer = GL_NONE;
    glGetIntegerv(GL_READ_BUFFER, &read_buffer);
    glReadBuffer(drawBuffer());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    const std::string raised = takeGlErrors();
    glReadBuffer(static_cast<GLenum>(read_buffer));
    if (!raised.empty()) {
        return Error{SLUICE_ERROR_UNSUPPORTED, kThing,
                     fmt::format("its {} samples could not be resolved, OpenGL raised {}", target.samples, raised),
                     "draw the world without samples"};
    }
    return {};
}

}  // namespace sluice::host
