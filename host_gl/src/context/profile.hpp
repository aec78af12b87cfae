// SPDX-License-Identifier: MIT
// What kind of OpenGL the current context is, where the same work is done in two ways.
#pragma once

namespace sluice::host {

/// Whether the context still has what OpenGL 3.1 took away: immediate mode, GLSL 1.20, the alpha test, pixel transfer.
[[nodiscard]] bool hasFixedFunction();

/// While one of these lives on a thread, nothing that is destroyed there asks GL to free its objects: the context that
/// held them is gone or out of reach, and their names would be those of somebody else in the present one.
class GlGone {
  public:
    GlGone();
    ~GlGone();
    GlGone(const GlGone&) = delete;
    GlGone& operator=(const GlGone&) = delete;

  private:
    bool before_;
};
[[nodiscard]] bool glGone();

}  // namespace sluice::host
