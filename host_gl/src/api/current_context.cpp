// SPDX-License-Identifier: MIT
#include "api/current_context.hpp"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

namespace sluice::host {

namespace {

// GLX by hand: this library needs no X, and its headers would make it a need of every build.
struct Glx {
    void* (*current_context)() = nullptr;
    void* (*current_display)() = nullptr;
    unsigned long (*current_drawable)() = nullptr;
    void (*query_drawable)(void* display, unsigned long drawable, int attribute, unsigned* value) = nullptr;

    [[nodiscard]] bool complete() const {
        return current_context != nullptr && current_display != nullptr && current_drawable != nullptr &&
               query_drawable != nullptr;
    }
};
constexpr int kGlxWidth = 0x801D;   // GLX_WIDTH
constexpr int kGlxHeight = 0x801E;  // GLX_HEIGHT

template <typename Function>
void look(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(::dlsym(library, name));
}

/// What the engine has loaded already; nothing is loaded for it.
Glx loadedGlx() {
    for (const char* name : {"libGLX.so.0", "libGL.so.1"}) {
        void* library = ::dlopen(name, RTLD_LAZY | RTLD_NOLOAD);
        if (library == nullptr) {
            continue;
        }
        Glx glx;
        look(library, "glXGetCurrentContext", glx.current_context);
        look(library, "glXGetCurrentDisplay", glx.current_display);
        look(library, "glXGetCurrentDrawable", glx.current_drawable);
        look(library, "glXQueryDrawable", glx.query_drawable);
        ::dlclose(library);  // the engine holds it as long as it has a context
        if (glx.complete()) {
            return glx;
        }
    }
    return {};
}

}  // namespace

CurrentContext currentContext() {
    if (const void* egl = eglGetCurrentContext(); egl != EGL_NO_CONTEXT) {
        return {ContextKind::Egl, egl};
    }
    const Glx glx = loadedGlx();
    if (glx.complete()) {
        if (const void* context = glx.current_context(); context != nullptr) {
            return {ContextKind::Glx, context};
        }
    }
    return {};
}

std::optional<Extent> drawableExtent(const CurrentContext& context) {
    if (context.kind == ContextKind::Egl) {
        EGLint width = 0;
        EGLint height = 0;
        EGLDisplay display = eglGetCurrentDisplay();
        EGLSurface surface = eglGetCurrentSurface(EGL_DRAW);
        if (surface != EGL_NO_SURFACE && eglQuerySurface(display, surface, EGL_WIDTH, &width) == EGL_TRUE &&
            eglQuerySurface(display, surface, EGL_HEIGHT, &height) == EGL_TRUE && width > 0 && height > 0) {
            return Extent{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
        }
        return std::nullopt;
    }
    const Glx glx = context.kind == ContextKind::Glx ? loadedGlx() : Glx{};
    if (!glx.complete() || glx.current_drawable() == 0) {
        return std::nullopt;
    }
    unsigned width = 0;
    unsigned height = 0;
    glx.query_drawable(glx.current_display(), glx.current_drawable(), kGlxWidth, &width);
    glx.query_drawable(glx.current_display(), glx.current_drawable(), kGlxHeight, &height);
    if (width == 0 || height == 0) {
        return std::nullopt;
    }
    return Extent{width, height};
}

Error noContext(const char* call) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, call, "no EGL or GLX context is current on this thread",
            "call it on the thread that draws, after the context was made current"};
}

Status checkContext() {
    if (!epoxy_is_desktop_gl() || epoxy_gl_version() < 21) {
        const int version = epoxy_gl_version();
        return Error{SLUICE_ERROR_UNSUPPORTED, "OpenGL context",
                     fmt::format("found {}{}.{}", epoxy_is_desktop_gl() ? "" : "ES ", version / 10, version % 10),
                     "desktop OpenGL with 2.1 or newer in GL_VERSION is needed"};
    }
    if (epoxy_gl_version() < 30 && !epoxy_has_gl_extension("GL_ARB_framebuffer_object")) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "OpenGL context", "GL_ARB_framebuffer_object is missing",
                     "update the GL driver"};
    }
    return {};
}

}  // namespace sluice::host
