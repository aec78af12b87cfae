// SPDX-License-Identifier: MIT
#include "timeline/bridge_context.hpp"

#include <epoxy/egl.h>

#include "context/egl_display.hpp"

namespace sluice::host {

namespace {

constexpr const char* kThing = "bridged timeline";
constexpr const char* kRemedy = "request the finish timeline";

/// The config of a context, EGL_NO_CONFIG_KHR if it was made without one.
EGLConfig configOf(EGLDisplay display, EGLContext context) {
    EGLint id = 0;
    if (eglQueryContext(display, context, EGL_CONFIG_ID, &id) != EGL_TRUE || id == 0) {
        return EGL_NO_CONFIG_KHR;
    }
    const EGLint wanted[] = {EGL_CONFIG_ID, id, EGL_NONE};
    EGLConfig config = EGL_NO_CONFIG_KHR;
    EGLint count = 0;
    if (eglChooseConfig(display, wanted, &config, 1, &count) != EGL_TRUE || count != 1) {
        return EGL_NO_CONFIG_KHR;
    }
    return config;
}

/// Whether the current context was made to lose itself, and say so, when the GPU is reset.
bool isToldOfResets() {
    if (epoxy_gl_version() < 45 && !epoxy_has_gl_extension("GL_KHR_robustness") &&
        !epoxy_has_gl_extension("GL_ARB_robustness")) {
        return false;
    }
    GLint strategy = 0;
    glGetIntegerv(GL_RESET_NOTIFICATION_STRATEGY, &strategy);
    return strategy == GL_LOSE_CONTEXT_ON_RESET;
}

}  // namespace

Result<BridgeContext> BridgeContext::createSharedWithCurrent() {
    EGLDisplay display = eglGetCurrentDisplay();
    EGLContext current = eglGetCurrentContext();
    if (display == EGL_NO_DISPLAY || current == EGL_NO_CONTEXT) {
        return Error{SLUICE_ERROR_UNSUPPORTED, kThing, "no EGL context is current on this thread", kRemedy};
    }
    eglBindAPI(EGL_OPENGL_API);
    // Fences and nothing else: the oldest version will do, and every driver can share with it. But EGL shares only
    // between contexts that are told of resets in the same way.
    const EGLint plain[] = {EGL_NONE};
    const EGLint told[] = {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET, EGL_NONE};
    EGLContext context =
        eglCreateContext(display, configOf(display, current), current, isToldOfResets() ? told : plain);
    if (context == EGL_NO_CONTEXT) {
        return Error{SLUICE_ERROR_UNSUPPORTED, kThing, "eglCreateContext for its thread failed: " + takeEglError(),
                     kRemedy};
    }
    return BridgeContext(display, context);
}

Status BridgeContext::makeCurrent() const {
    eglBindAPI(EGL_OPENGL_API);
    if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
        return Error{SLUICE_ERROR_UNSUPPORTED, kThing, "eglMakeCurrent on its thread failed: " + takeEglError(),
                     kRemedy};
    }
    return {};
}

void BridgeContext::release() const {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglReleaseThread();
}

BridgeContext::~BridgeContext() {
    if (context_ != nullptr) {
        eglDestroyContext(display_, context_);
    }
}

}  // namespace sluice::host
