// SPDX-License-Identifier: MIT
#include <epoxy/gl.h>
// After epoxy/gl.h, which must be the first to declare OpenGL.
#include <fmt/format.h>

#include <array>

#include "context/egl_display.hpp"
#include "sluice/host_gl/context.hpp"

namespace sluice::host {

struct GlContext::Impl {
    std::shared_ptr<EglDisplay> display;
    EGLContext context = EGL_NO_CONTEXT;

    Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        if (context == EGL_NO_CONTEXT) {
            return;
        }
        release();
        eglDestroyContext(display->handle(), context);
    }

    void release() const {
        // The current API is a thread's own state, and another library may have chosen OpenGL ES on this thread.
        const EGLenum api = eglQueryAPI();
        eglBindAPI(EGL_OPENGL_API);
        if (eglGetCurrentContext() == context) {
            eglMakeCurrent(display->handle(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        }
        eglBindAPI(api);
    }

    static Result<std::unique_ptr<Impl>> make(std::shared_ptr<EglDisplay> display, EGLContext share) {
        auto impl = std::make_unique<Impl>();
        impl->display = std::move(display);
        if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) {
            return Error{SLUICE_ERROR_UNSUPPORTED, "eglBindAPI(EGL_OPENGL_API)", takeEglError(),
                         "this EGL library has no desktop OpenGL; install libegl-mesa0 and libgl1-mesa-dri"};
        }
        // Told of a reset where the driver can tell (contextLoss()); a driver that cannot may refuse to be asked.
        const std::array<EGLint, 7> told{EGL_CONTEXT_MAJOR_VERSION,
                                         2,
                                         EGL_CONTEXT_MINOR_VERSION,
                                         1,
                                         EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                         EGL_LOSE_CONTEXT_ON_RESET,
                                         EGL_NONE};
        impl->context = eglCreateContext(impl->display->handle(), impl->display->config(), share, told.data());
        if (impl->context == EGL_NO_CONTEXT) {
            const std::array<EGLint, 5> plain{EGL_CONTEXT_MAJOR_VERSION, 2, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE};
            impl->context = eglCreateContext(impl->display->handle(), impl->display->config(), share, plain.data());
        }
        if (impl->context == EGL_NO_CONTEXT) {
            return Error{SLUICE_ERROR_UNSUPPORTED, "eglCreateContext(OpenGL 2.1)", takeEglError(),
                         "install libgl1-mesa-dri or a driver with compatibility OpenGL 2.1 or newer"};
        }
        return impl;
    }
};

GlContext::GlContext(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GlContext::GlContext(GlContext&&) noexcept = default;
GlContext& GlContext::operator=(GlContext&&) noexcept = default;
GlContext::~GlContext() = default;

Result<GlContext> GlContext::create() {
    auto display = EglDisplay::open();
    if (!display.ok()) {
        return display.error();
    }
    auto impl = Impl::make(std::move(display).value(), EGL_NO_CONTEXT);
    if (!impl.ok()) {
        return impl.error();
    }
    return GlContext(std::move(impl).value());
}

Result<GlContext> GlContext::createShared() const {
    auto impl = Impl::make(impl_->display, impl_->context);
    if (!impl.ok()) {
        return impl.error();
    }
    return GlContext(std::move(impl).value());
}

Status GlContext::makeCurrent() const {
    eglBindAPI(EGL_OPENGL_API);
    if (eglMakeCurrent(impl_->display->handle(), EGL_NO_SURFACE, EGL_NO_SURFACE, impl_->context) != EGL_TRUE) {
        return Error{SLUICE_ERROR_INTERNAL, "eglMakeCurrent", takeEglError(),
                     "release the context on the thread that holds it first"};
    }
    const int version = epoxy_gl_version();  // 21 for 2.1
    if (version < 21 || !epoxy_is_desktop_gl()) {
        release();
        return Error{SLUICE_ERROR_UNSUPPORTED, "OpenGL version",
                     fmt::format("found {}.{}, need desktop 2.1", version / 10, version % 10),
                     "install libgl1-mesa-dri or update the GPU driver"};
    }
    return {};
}

void GlContext::release() const {
    impl_->release();
}

}  // namespace sluice::host
