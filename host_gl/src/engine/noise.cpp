// SPDX-License-Identifier: MIT
#include "engine/noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sluice::host {
namespace {

constexpr std::uint32_t kSalt = 0x51C1CEU;

float valueNoise(float u, float v, int period, std::uint32_t salt) {
    const float x = u * static_cast<float>(period);
    const float y = v * static_cast<float>(period);
    const int xi = static_cast<int>(std::floor(x));
    const int yi = static_cast<int>(std::floor(y));
    const float fx = x - static_cast<float>(xi);
    const float fy = y - static_cast<float>(yi);
    const float sx = fx * fx * (3.0F - 2.0F * fx);
    const float sy = fy * fy * (3.0F - 2.0F * fy);
    const auto corner = [&](int dx, int dy) { return hashUnit((xi + dx) % period, (yi + dy) % period, salt); };
    const float low = corner(0, 0) + (corner(1, 0) - corner(0, 0)) * sx;
    const float high = corner(0, 1) + (corner(1, 1) - corner(0, 1)) * sx;
    return low + (high - low) * sy;
}

}  // namespace

float hashUnit(std::int32_t x, std::int32_t y, std::uint32_t salt) {
    // Multiply-and-xorshift mixing; any mixer with good avalanche would do.
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1U ^ static_cast<std::uint32_t>(y) * 0x85EBCA77U ^ salt;
    h = (h ^ (h >> 15U)) * 0x2C1B3C6DU;
    h = (h ^ (h >> 12U)) * 0x297A2D39U;
    h ^= h >> 15U;
    return static_cast<float>(h >> 8U) / 16777216.0F;
}

NoiseField::NoiseField() : values_(std::size_t{kSize} * kSize) {
    constexpr int kOctaves = 5;
    constexpr int kFirstPeriod = 4;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const float u = static_cast<float>(x) / kSize;
            const float v = static_cast<float>(y) / kSize;
            float sum = 0.0F;
            float weight = 0.5F;
            for (int octave = 0; octave < kOctaves; ++octave) {
                sum += weight * valueNoise(u, v, kFirstPeriod << octave, kSalt + static_cast<std::uint32_t>(octave));
                weight *= 0.5F;
            }
            values_[static_cast<std::size_t>(y) * kSize + static_cast<std::size_t>(x)] = std::clamp(sum, 0.0F, 1.0F);
        }
    }
}

float NoiseField::texel(int x, int y) const {
    return values_[static_cast<std::size_t>(y & (kSize - 1)) * kSize + static_cast<std::size_t>(x & (kSize - 1))];
}

float NoiseField::at(float u, float v) const {
    const float x = u * kSize;
    const float y = v * kSize;
    const float x0 = std::floor(x);
    const float y0 = std::floor(y);
    const int xi = static_cast<int>(x0);
    const int yi = static_cast<int>(y0);
    const float fx = x - x0;
    const float fy = y - y0;
    const float low = texel(xi, yi) + (texel(xi + 1, yi) - texel(xi, yi)) * fx;
    const float high = texel(xi, yi + 1) + (texel(xi + 1, yi + 1) - texel(xi, yi + 1)) * fx;
    return low + (high - low) * fy;
}

}  // namespace sluice::host
