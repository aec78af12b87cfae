// SPDX-License-Identifier: MIT
#include "engine/texture.hpp"

#include <epoxy/gl.h>

#include "screen/gl_guards.hpp"

namespace sluice::host {
namespace {

/// Tuned on llvmpipe: 4 keeps the floor sharp at grazing angles; 16 costs several times the frame for little more.
constexpr float kAnisotropy = 4.0F;

}  // namespace

Texture::Texture(const Image& image) {
    const TextureGuard binding;
    const PixelGuard pixels;
    glGenTextures(1, &name_);
    glBindTexture(GL_TEXTURE_2D, name_);
    glTexParameteri(GL_TEXTURE_2D, GL_GENERATE_MIPMAP, GL_TRUE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    if (epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic")) {
        GLfloat most = 1.0F;
        glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &most);
        glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, std::min(most, kAnisotropy));
    }
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
}

Texture Texture::alphaFalloff() {
    constexpr int kSize = 64;
    std::vector<std::uint8_t> alpha;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const float s = static_cast<float>(x) / (kSize - 1);
            const float t = static_cast<float>(y) / (kSize - 1);
            const float left = std::max(0.0F, 1.0F - std::hypot(s, t));
            alpha.push_back(static_cast<std::uint8_t>(std::lround(255.0F * left * left)));
        }
    }
    const TextureGuard binding;
    const PixelGuard pixels;
    Texture texture;
    glGenTextures(1, &texture.name_);
    glBindTexture(GL_TEXTURE_2D, texture.name_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_ALPHA8, kSize, kSize, 0, GL_ALPHA, GL_UNSIGNED_BYTE, alpha.data());
    return texture;
}

Texture::~Texture() {
    if (name_ != 0) {
        glDeleteTextures(1, &name_);
    }
}

void Texture::bind() const {
    glBindTexture(GL_TEXTURE_2D, name_);
}

}  // namespace sluice::host
