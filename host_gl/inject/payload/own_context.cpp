// SPDX-License-Identifier: MIT
#include "payload/own_context.hpp"

#include <epoxy/egl.h>
#include <fmt/format.h>

#include <array>

namespace sluice::inject {

namespace {

constexpr const char* kThing = "OpenGL ES";
constexpr const char* kRemedy = "run a program of desktop OpenGL";

Error none(std::string why) {
    return {SLUICE_ERROR_UNSUPPORTED, kThing, std::move(why), kRemedy};
}

/// The config of the surface that is drawn to.
void* configOf(const GlCalls& gl, void* display) {
    int id = 0;
    if (gl.eglSurfaceValue(display, gl.eglSurface(EGL_DRAW), EGL_CONFIG_ID, &id) == EGL_FALSE) {
        return nullptr;
    }
    const std::array<int, 3> wanted{EGL_CONFIG_ID, id, EGL_NONE};
    void* config = nullptr;
    int count = 0;
    return gl.eglConfigs(display, wanted.data(), &config, 1, &count) != EGL_FALSE && count == 1 ? config : nullptr;
}

}  // namespace

Result<std::unique_ptr<OwnContext>> OwnContext::create(const GlCalls& gl, const CurrentContext& program) {
    if (program.api != SLUICE_INJECT_EGL) {
        return none("it gets no fluid in a context of GLX");
    }
    const bool whole = gl.eglSurface != nullptr && gl.eglSurfaceValue != nullptr && gl.eglConfigs != nullptr &&
                       gl.eglConfigValue != nullptr && gl.eglBindApi != nullptr && gl.eglQueryApi != nullptr &&
                       gl.eglMakeContext != nullptr && gl.eglEndContext != nullptr && gl.eglUse != nullptr;
    void* config = whole ? configOf(gl, program.display) : nullptr;
    int renders = 0;
    if (config == nullptr || gl.eglConfigValue(program.display, config, EGL_RENDERABLE_TYPE, &renders) == EGL_FALSE ||
        (renders & EGL_OPENGL_BIT) == 0) {
        return none("its surface cannot be drawn to by desktop OpenGL, which the fluid needs");
    }
    const unsigned api = gl.eglQueryApi();
    (void)gl.eglBindApi(EGL_OPENGL_API);
    const std::array<int, 1> plain{EGL_NONE};
    void* context = gl.eglMakeContext(program.display, config, nullptr, plain.data());
    (void)gl.eglBindApi(api);
    if (context == nullptr) {
        return none("no context of desktop OpenGL could be made beside it, which the fluid needs");
    }
    return std::unique_ptr<OwnContext>(new OwnContext(gl, program.display, context));
}

OwnContext::~OwnContext() {
    (void)gl_.eglEndContext(display_, context_);
}

OwnContext::Turn::Turn(const OwnContext& of)
    : gl_(of.gl_),
      api_(gl_.eglQueryApi()),
      display_(gl_.eglDisplay()),
      draw_(gl_.eglSurface(EGL_DRAW)),
      read_(gl_.eglSurface(EGL_READ)),
      context_(gl_.eglContext()),
      ok_(context_ != nullptr && display_ == of.display_ &&
          gl_.eglUse(display_, draw_, read_, of.context_) != EGL_FALSE) {
    if (ok_) {
        (void)gl_.eglBindApi(EGL_OPENGL_API);
    }
}

OwnContext::Turn::~Turn() {
    if (ok_) {
        (void)gl_.eglBindApi(api_);
        (void)gl_.eglUse(display_, draw_, read_, context_);
    }
}

}  // namespace sluice::inject
