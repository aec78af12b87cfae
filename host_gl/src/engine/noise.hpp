// SPDX-License-Identifier: MIT
// Noise for the procedural textures; the same on every machine.
#pragma once

#include <cstdint>
#include <vector>

namespace sluice::host {

/// A number in [0,1) that depends on both integers and the salt.
[[nodiscard]] float hashUnit(std::int32_t x, std::int32_t y, std::uint32_t salt);

/// Fractal value noise with period 1 in u and v, tabulated once because every texture samples it many times.
class NoiseField {
  public:
    NoiseField();
    /// Mean about 0.5, range [0,1].
    [[nodiscard]] float at(float u, float v) const;

  private:
    static constexpr int kSize = 256;
    [[nodiscard]] float texel(int x, int y) const;
    std::vector<float> values_;
};

}  // namespace sluice::host
