// SPDX-License-Identifier: MIT
// Scopes that put back the GL state which reading or probing has to disturb.
#pragma once

#include <epoxy/gl.h>

#include <array>

namespace sluice::host {

/// The draw and read framebuffers and the renderbuffer, put back at the end of the scope.
class FramebufferGuard {
  public:
    FramebufferGuard();
    ~FramebufferGuard();
    FramebufferGuard(const FramebufferGuard&) = delete;
    FramebufferGuard& operator=(const FramebufferGuard&) = delete;

  private:
    GLint draw_ = 0, read_ = 0, renderbuffer_ = 0;
};

/// GL_TEXTURE_BINDING_2D of the active unit.
class TextureGuard {
  public:
    TextureGuard();
    ~TextureGuard();
    TextureGuard(const TextureGuard&) = delete;
    TextureGuard& operator=(const TextureGuard&) = delete;

  private:
    GLint texture_ = 0;
};

/// Pixel store, pixel transfer and pixel buffer state, at their defaults inside the scope except that rows are packed
/// tightly (alignment 1). Not glPushAttrib: that stack may be full in the host.
class PixelGuard {
  public:
    PixelGuard();
    ~PixelGuard();
    PixelGuard(const PixelGuard&) = delete;
    PixelGuard& operator=(const PixelGuard&) = delete;

  private:
    static constexpr std::size_t kStores = 16;
    static constexpr std::size_t kTransfers = 14;
    std::array<GLint, kStores> stores_{};
    std::array<GLfloat, kTransfers> transfers_{};
    bool has_transfers_;  ///< core profiles have none
    GLint pack_buffer_ = 0, unpack_buffer_ = 0;
};

/// Empties the GL error flag. Bounded, because a lost context reports errors without end.
void clearGlErrors();

}  // namespace sluice::host
