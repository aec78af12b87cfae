// SPDX-License-Identifier: MIT
// A mipmapped texture of the legacy engine, and the picture it is made from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/colour.hpp"

namespace sluice::host {

/// 8-bit RGB, row 0 at v = 0.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// Calls paint(u, v) -> Vec3 at every texel centre.
template <typename Paint>
[[nodiscard]] Image paintImage(int width, int height, const Paint& paint) {
    Image image{width, height, {}};
    image.rgb.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Vec3 colour = paint((static_cast<float>(x) + 0.5F) / static_cast<float>(width),
                                      (static_cast<float>(y) + 0.5F) / static_cast<float>(height));
            for (const float channel : colour) {
                image.rgb.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(channel, 0.0F, 1.0F) * 255.0F)));
            }
        }
    }
    return image;
}

/// Owns one GL texture name; freed with the context current.
class Texture {
  public:
    Texture() = default;
    /// Uploads with a mipmap chain, repeating, trilinear, and anisotropic where the driver offers it.
    explicit Texture(const Image& image);
    /// One channel that is alpha only, clamped, without mipmaps: the falloff of contact shadows.
    static Texture alphaFalloff();
    Texture(Texture&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Texture& operator=(Texture&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;
    ~Texture();

    void bind() const;

  private:
    std::uint32_t name_ = 0;
};

}  // namespace sluice::host
