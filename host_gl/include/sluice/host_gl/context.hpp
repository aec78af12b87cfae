// SPDX-License-Identifier: MIT
// An OpenGL compatibility context without a window.
#pragma once

#include <memory>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

/// An EGL surfaceless context that asks for OpenGL 2.1. Move-only; destroying it makes it not current.
/// Not thread-safe: current on one thread at a time.
class GlContext {
  public:
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

}  // namespace sluice::host
