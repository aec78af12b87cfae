// SPDX-License-Identifier: MIT
// The same engine with a window of an X server of its own.
#pragma once

#include <memory>

#include "caller.hpp"
#include "x_server.hpp"

namespace sluice::test {

/// A GLX context with a window, current on this thread while it lives.
class GlxCaller {
  public:
    /// Version 1.5 asks as engines of that time did, without a version.
    GlxCaller(const XServer& server, const Version& version, const Window& window);
    ~GlxCaller();
    GlxCaller(const GlxCaller&) = delete;
    GlxCaller& operator=(const GlxCaller&) = delete;
    [[nodiscard]] bool ok() const;
    void resize(int width, int height);
    void swap() const;

  private:
    struct Impl;  // Xlib's names are everybody's
    std::unique_ptr<Impl> impl_;
};

}  // namespace sluice::test
