// SPDX-License-Identifier: MIT
// An X server of a test's own.
#pragma once

#include <sys/types.h>

#include <string>

namespace sluice::test {

/// An Xvfb on a number that was free; ended with the object. display() is empty where there is none.
class XServer {
  public:
    explicit XServer(const char* screen = "640x480x24");
    ~XServer();
    XServer(const XServer&) = delete;
    XServer& operator=(const XServer&) = delete;
    [[nodiscard]] const std::string& display() const { return display_; }

  private:
    pid_t process_ = -1;
    std::string display_;
};

}  // namespace sluice::test
