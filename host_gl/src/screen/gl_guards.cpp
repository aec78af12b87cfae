// SPDX-License-Identifier: MIT
#include "screen/gl_guards.hpp"

#include "context/profile.hpp"

namespace sluice::host {
namespace {

struct Store {
    GLenum name;
    GLint neutral;
};
constexpr std::array<Store, 16> kStoreNames{{
    {GL_PACK_SWAP_BYTES, 0},
    {GL_PACK_LSB_FIRST, 0},
    {GL_PACK_ROW_LENGTH, 0},
    {GL_PACK_SKIP_ROWS, 0},
    {GL_PACK_SKIP_PIXELS, 0},
    {GL_PACK_ALIGNMENT, 1},
    {GL_PACK_IMAGE_HEIGHT, 0},
    {GL_PACK_SKIP_IMAGES, 0},
    {GL_UNPACK_SWAP_BYTES, 0},
    {GL_UNPACK_LSB_FIRST, 0},
    {GL_UNPACK_ROW_LENGTH, 0},
    {GL_UNPACK_SKIP_ROWS, 0},
    {GL_UNPACK_SKIP_PIXELS, 0},
    {GL_UNPACK_ALIGNMENT, 1},
    {GL_UNPACK_IMAGE_HEIGHT, 0},
    {GL_UNPACK_SKIP_IMAGES, 0},
}};

struct Transfer {
    GLenum name;
    GLfloat neutral;
};
constexpr std::array<Transfer, 14> kTransferNames{{
    {GL_MAP_COLOR, 0.0F},
    {GL_MAP_STENCIL, 0.0F},
    {GL_INDEX_SHIFT, 0.0F},
    {GL_INDEX_OFFSET, 0.0F},
    {GL_RED_SCALE, 1.0F},
    {GL_GREEN_SCALE, 1.0F},
    {GL_BLUE_SCALE, 1.0F},
    {GL_ALPHA_SCALE, 1.0F},
    {GL_DEPTH_SCALE, 1.0F},
    {GL_RED_BIAS, 0.0F},
    {GL_GREEN_BIAS, 0.0F},
    {GL_BLUE_BIAS, 0.0F},
    {GL_ALPHA_BIAS, 0.0F},
    {GL_DEPTH_BIAS, 0.0F},
}};

}  // namespace

FramebufferGuard::FramebufferGuard() {
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_);
    glGetIntegerv(GL_RENDERBUFFER_BINDING, &renderbuffer_);
}

FramebufferGuard::~FramebufferGuard() {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read_));
    glBindRenderbuffer(GL_RENDERBUFFER, static_cast<GLuint>(renderbuffer_));
}

TextureGuard::TextureGuard() {
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture_);
}

TextureGuard::~TextureGuard() {
    glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(texture_));
}

PixelGuard::PixelGuard() : has_transfers_(hasFixedFunction()) {
    for (std::size_t i = 0; i < kStores; ++i) {
        glGetIntegerv(kStoreNames[i].name, &stores_[i]);
        glPixelStorei(kStoreNames[i].name, kStoreNames[i].neutral);
    }
    for (std::size_t i = 0; has_transfers_ && i < kTransfers; ++i) {
        glGetFloatv(kTransferNames[i].name, &transfers_[i]);
        glPixelTransferf(kTransferNames[i].name, kTransferNames[i].neutral);
    }
    glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &pack_buffer_);
    glGetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &unpack_buffer_);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

PixelGuard::~PixelGuard() {
    for (std::size_t i = 0; i < kStores; ++i) {
        glPixelStorei(kStoreNames[i].name, stores_[i]);
    }
    for (std::size_t i = 0; has_transfers_ && i < kTransfers; ++i) {
        glPixelTransferf(kTransferNames[i].name, transfers_[i]);
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(pack_buffer_));
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpack_buffer_));
}

void clearGlErrors() {
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
    }
}

}  // namespace sluice::host
