// SPDX-License-Identifier: MIT
// One initialised EGLDisplay, shared by every context on it.
#pragma once

#include <epoxy/egl.h>

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "sluice/result.hpp"

namespace sluice::host {

/// An initialised display. EGL hands the same EGLDisplay to everyone in the process who asks for the same platform, and
/// eglTerminate takes it away from all of them, so terminations are counted per display and only the last one happens.
/// Thread-safe to create and destroy.
class EglDisplay {
  public:
    /// What SLUICE_GL_DEVICE asks for. By default the surfaceless platform of Mesa, else the first device of
    /// EGL_EXT_platform_device that has desktop OpenGL and surfaceless contexts.
    [[nodiscard]] static Result<std::shared_ptr<EglDisplay>> open();
    EglDisplay(const EglDisplay&) = delete;
    EglDisplay& operator=(const EglDisplay&) = delete;
    ~EglDisplay();

    [[nodiscard]] EGLDisplay handle() const { return display_; }
    /// EGL_NO_CONFIG_KHR where the display has it, else a config for desktop OpenGL.
    [[nodiscard]] EGLConfig config() const { return config_; }

  private:
    EglDisplay(EGLDisplay display, EGLConfig config) : display_(display), config_(config) {}
    static Result<std::shared_ptr<EglDisplay>> openDevice(std::size_t index);
    static Result<std::shared_ptr<EglDisplay>> initialise(EGLDisplay display, std::string_view platform);

    EGLDisplay display_;
    EGLConfig config_;
};

/// "EGL_BAD_MATCH (0x3009)" for the calling thread's last EGL error, which is cleared.
[[nodiscard]] std::string takeEglError();

}  // namespace sluice::host
