// SPDX-License-Identifier: MIT
// The same engine with a window of an X server of its own.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

#include "caller.hpp"

namespace sluice::test {

/// An Xvfb that ends with this object. name() is empty where there is none.
class XServer {
  public:
    XServer();
    ~XServer();
    XServer(const XServer&) = delete;
    XServer& operator=(const XServer&) = delete;
    [[nodiscard]] const std::string& name() const { return name_; }

  private:
    pid_t pid_ = -1;
    std::string name_;
};

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
