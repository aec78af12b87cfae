// SPDX-License-Identifier: MIT
#include "payload/gl_calls.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <cstdio>
#include <string>
#include <string_view>

namespace sluice::inject {

namespace {

constexpr int kGlxWidth = 0x801D, kGlxHeight = 0x801E;  // glx.h would bring in all of Xlib

template <typename T>
void look(const SluiceInjectShim& shim, const char* name, T& out) {
    out = reinterpret_cast<T>(shim.real(name));
}

std::string text(const GlCalls& gl, GLenum name) {
    const unsigned char* found = gl.getString(name);
    return found == nullptr ? "" : reinterpret_cast<const char*>(found);
}

std::int32_t integer(const GlCalls& gl, GLenum name) {
    std::int32_t value = 0;
    gl.getIntegerv(name, &value);
    return value;
}

/// Of "4.5 (Compatibility Profile) Mesa 22.3.6", "OpenGL ES 3.2 Mesa 22.3.6" and "OpenGL ES-CM 1.1".
std::int32_t numberOf(const std::string& version) {
    const std::size_t digit = version.find_first_of("0123456789");
    int major = 0;
    int minor = 0;
    const bool found = digit != std::string::npos && std::sscanf(version.c_str() + digit, "%d.%d", &major, &minor) == 2;
    return found ? 10 * major + minor : 0;
}

/// Without a call that would be an error, of which a debug callback of the program's would hear.
bool hasFixedFunction(const GlCalls& gl, std::int32_t version) {
    if (version < 31) {
        return true;
    }
    if (version == 31) {
        std::array<float, 16> projection{};  // as many extension lists as drivers; the question itself
        gl.getFloatv(GL_PROJECTION_MATRIX, projection.data());
        return gl.getError() == GL_NO_ERROR;
    }
    const std::int32_t profile = integer(gl, GL_CONTEXT_PROFILE_MASK);
    return (profile & GL_CONTEXT_COMPATIBILITY_PROFILE_BIT) != 0 || profile == 0;
}

}  // namespace

GlCalls loadGlCalls(const SluiceInjectShim& shim) {
    GlCalls gl;
    look(shim, "glGetError", gl.getError);
    look(shim, "glGetIntegerv", gl.getIntegerv);
    look(shim, "glGetFloatv", gl.getFloatv);
    look(shim, "glGetString", gl.getString);
    look(shim, "glGetFramebufferAttachmentParameteriv", gl.getAttachment);
    look(shim, "glBindFramebuffer", gl.bindFramebuffer);
    look(shim, "glIsProgram", gl.isProgram);
    look(shim, "glGetProgramiv", gl.getProgramiv);
    look(shim, "glGetActiveUniform", gl.getActiveUniform);
    look(shim, "glGetUniformLocation", gl.getUniformLocation);
    look(shim, "glGetUniformfv", gl.getUniformfv);
    look(shim, "glReadPixels", gl.readPixels);
    look(shim, "glGetActiveUniformsiv", gl.getActiveUniformsiv);
    look(shim, "glGetActiveUniformBlockiv", gl.getActiveUniformBlockiv);
    look(shim, "glGetIntegeri_v", gl.getIntegeri);
    look(shim, "glBindBuffer", gl.bindBuffer);
    look(shim, "glGetBufferParameteriv", gl.getBufferParameteriv);
    look(shim, "glGetBufferSubData", gl.getBufferSubData);
    look(shim, "glMapBufferRange", gl.mapBufferRange);
    look(shim, "glUnmapBuffer", gl.unmapBuffer);
    look(shim, "glXGetCurrentContext", gl.glxContext);
    look(shim, "glXGetCurrentDisplay", gl.glxDisplay);
    look(shim, "glXGetCurrentDrawable", gl.glxDrawable);
    look(shim, "glXQueryDrawable", gl.glxQueryDrawable);
    look(shim, "eglGetCurrentContext", gl.eglContext);
    look(shim, "eglGetCurrentDisplay", gl.eglDisplay);
    look(shim, "eglGetCurrentSurface", gl.eglSurface);
    look(shim, "eglQuerySurface", gl.eglSurfaceValue);
    look(shim, "eglChooseConfig", gl.eglConfigs);
    look(shim, "eglGetConfigAttrib", gl.eglConfigValue);
    look(shim, "eglBindAPI", gl.eglBindApi);
    look(shim, "eglQueryAPI", gl.eglQueryApi);
    look(shim, "eglCreateContext", gl.eglMakeContext);
    look(shim, "eglDestroyContext", gl.eglEndContext);
    look(shim, "eglMakeCurrent", gl.eglUse);
    return gl;
}

CurrentContext currentContext(const GlCalls& gl) {
    CurrentContext current;
    if (gl.glxContext != nullptr && gl.glxDisplay != nullptr && gl.glxDrawable != nullptr) {
        current.context = gl.glxContext();
        if (current.context != nullptr) {
            current.display = gl.glxDisplay();
            current.drawable = gl.glxDrawable();
            return current;
        }
    }
    if (gl.eglContext != nullptr && gl.eglDisplay != nullptr && gl.eglSurface != nullptr) {
        current.context = gl.eglContext();
        if (current.context != nullptr) {
            current.api = SLUICE_INJECT_EGL;
            current.display = gl.eglDisplay();
            current.drawable = reinterpret_cast<std::uintptr_t>(gl.eglSurface(EGL_DRAW));
        }
    }
    return current;
}

DrawableSize drawableSize(const GlCalls& gl, const CurrentContext& current) {
    if (current.context == nullptr || current.drawable == 0) {
        return {};
    }
    if (current.api == SLUICE_INJECT_GLX && gl.glxQueryDrawable != nullptr) {
        unsigned width = 0;
        unsigned height = 0;
        gl.glxQueryDrawable(current.display, current.drawable, kGlxWidth, &width);
        gl.glxQueryDrawable(current.display, current.drawable, kGlxHeight, &height);
        return {width, height};
    }
    if (current.api == SLUICE_INJECT_EGL && gl.eglSurfaceValue != nullptr) {
        int width = 0;
        int height = 0;
        void* const surface =
            reinterpret_cast<void*>(current.drawable);  // NOLINT(performance-no-int-to-ptr): it was one
        (void)gl.eglSurfaceValue(current.display, surface, EGL_WIDTH, &width);
        (void)gl.eglSurfaceValue(current.display, surface, EGL_HEIGHT, &height);
        return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
    }
    return {};
}

void forgetErrors(const GlCalls& gl) {
    for (int i = 0; i < 8 && gl.getError() != GL_NO_ERROR; ++i) {  // a lost context has no end of them
    }
}

ContextFacts contextFacts(const GlCalls& gl) {
    ContextFacts facts;
    facts.renderer = text(gl, GL_RENDERER);
    facts.version = text(gl, GL_VERSION);
    facts.number = numberOf(facts.version);
    facts.embedded = std::string_view(facts.version).starts_with("OpenGL ES");
    facts.compatibility = facts.embedded ? facts.number < 20 : hasFixedFunction(gl, facts.number);
    facts.clip_control = !facts.embedded && (facts.number >= 45 || epoxy_has_gl_extension("GL_ARB_clip_control"));
    facts.stereo = !facts.embedded && integer(gl, GL_STEREO) != 0;
    facts.samples = integer(gl, GL_SAMPLES);
    if (facts.compatibility || facts.embedded || gl.getAttachment == nullptr) {
        facts.depth_bits = integer(gl, GL_DEPTH_BITS);
        facts.stencil_bits = integer(gl, GL_STENCIL_BITS);
    } else {
        gl.getAttachment(GL_FRAMEBUFFER, GL_DEPTH, GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE, &facts.depth_bits);
        gl.getAttachment(GL_FRAMEBUFFER, GL_STENCIL, GL_FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE, &facts.stencil_bits);
    }
    return facts;
}

}  // namespace sluice::inject
