// SPDX-License-Identifier: MIT
// The state of a host that takes no prisoners.
#pragma once

#include <epoxy/gl.h>

#include <cstdint>

namespace sluice::host::test {

/// Sets as much unusual state as one context can hold, and frees it at the end. With `screen` bound as both
/// framebuffers and its buffers deselected.
class HostileState {
  public:
    explicit HostileState(std::uint32_t screen);
    HostileState(const HostileState&) = delete;
    HostileState& operator=(const HostileState&) = delete;
    ~HostileState();

  private:
    void bindObjects();
    static void setRasterState();
    static void setPixelState();
    static void setMatricesAndStacks();

    GLuint program_ = 0, vertex_array_ = 0, buffer_ = 0, pixel_buffer_ = 0, sampler_ = 0, texture_ = 0;
};

}  // namespace sluice::host::test
