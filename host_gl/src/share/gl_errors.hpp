// SPDX-License-Identifier: MIT
// GL's error flags: as text, and set aside while calls of our own are checked.
#pragma once

#include <epoxy/gl.h>

#include <string>
#include <vector>

namespace sluice::host {

/// Names of the pending flags, cleared; empty if there were none. Takes the host's flags with it, so for creation and
/// imports only; in a frame use GlErrorScope.
[[nodiscard]] std::string takeGlErrors();

/// Sets the host's pending flags aside, so that what our own calls raise can be told from them, and raises them again
/// at the end. OpenGL has no call that sets a flag, so each is raised by a call that is refused for that reason and
/// changes nothing. GL_OUT_OF_MEMORY and the rarer flags cannot be raised at will and come back as
/// GL_INVALID_OPERATION.
class GlErrorScope {
  public:
    GlErrorScope();
    /// Drops what nobody took, then raises the host's flags.
    ~GlErrorScope();
    GlErrorScope(const GlErrorScope&) = delete;
    GlErrorScope& operator=(const GlErrorScope&) = delete;

    /// Names of what was raised inside the scope since the last call; empty if nothing was.
    [[nodiscard]] static std::string take() { return takeGlErrors(); }

  private:
    std::vector<GLenum> found_;
};

}  // namespace sluice::host
