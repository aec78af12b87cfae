// SPDX-License-Identifier: MIT
// An OpenGL compatibility context without a window.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

/// An EGL surfaceless context that asks for OpenGL 2.1. Move-only; destroying it makes it not current.
/// Not thread-safe: current on one thread at a time.
///
/// The environment variable SLUICE_GL_DEVICE chooses the device: "surfaceless", the default, is Mesa's surfaceless
/// platform (or else the first EGL device that will do), which with several drivers installed is Mesa's own even beside
/// another vendor's card; a number is the index of an EGL device, in the order of eglDevices().
class GlContext {
  public:
    /// Fails naming SLUICE_GL_DEVICE when that holds anything else, or a device that has no such context.
    [[nodiscard]] static Result<GlContext> create();
    /// A context in the same share group, for another thread (made current there by the caller).
    [[nodiscard]] Result<GlContext> createShared() const;
    GlContext(GlContext&&) noexcept;
    GlContext& operator=(GlContext&&) noexcept;
    ~GlContext();

    [[nodiscard]] Status makeCurrent() const;
    void release() const;

  private:
    struct Impl;
    explicit GlContext(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// What the current context can do, queried (formats by making a small texture and framebuffer of each).
[[nodiscard]] SluiceHostCapabilities queryCapabilities();

/// How the current context has been lost, where the driver tells and the context was made so that it does (as
/// GlContext's are, where EGL can); else empty. From then on GL does nothing: make another context, and everything in
/// it.
[[nodiscard]] std::string_view contextLoss();

/// One line per EGL device: its index (for SLUICE_GL_DEVICE), vendor, name and device file as far as the driver tells
/// them, and its extensions in brackets. Empty where EGL cannot list devices. Needs no context.
[[nodiscard]] std::vector<std::string> eglDevices();

/// A remark for the user when the current context is a software renderer although some EGL device is not; else empty.
/// Whoever asked for the software renderer with SLUICE_GL_DEVICE (its index, or "surfaceless") is not told.
[[nodiscard]] std::string glDeviceNote();

}  // namespace sluice::host
