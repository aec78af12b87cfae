// SPDX-License-Identifier: MIT
// A GL context for the bridge thread, in the share group of the host's.
#pragma once

#include <utility>

#include "sluice/result.hpp"

namespace sluice::host {

/// Made from whatever EGL context is current, so that a host which made its own context can use the bridge. Move-only.
class BridgeContext {
  public:
    /// Called on the thread that owns the host's context.
    [[nodiscard]] static Result<BridgeContext> createSharedWithCurrent();
    BridgeContext(BridgeContext&& other) noexcept
        : display_(std::exchange(other.display_, nullptr)), context_(std::exchange(other.context_, nullptr)) {}
    BridgeContext& operator=(BridgeContext&& other) noexcept {
        std::swap(display_, other.display_);
        std::swap(context_, other.context_);
        return *this;
    }
    BridgeContext(const BridgeContext&) = delete;
    BridgeContext& operator=(const BridgeContext&) = delete;
    ~BridgeContext();

    /// On the bridge thread.
    [[nodiscard]] Status makeCurrent() const;
    void release() const;

  private:
    BridgeContext(void* display, void* context) : display_(display), context_(context) {}
    void* display_ = nullptr;  // EGLDisplay
    void* context_ = nullptr;  // EGLContext
};

}  // namespace sluice::host
