// SPDX-License-Identifier: MIT
// A banner of cloth: the engine's own physics, on its CPU thread, as an engine of 2004 had it.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/colour.hpp"
#include "sluice/host_gl/engine.hpp"

namespace sluice::host {

/// Points on a square grid, moved by Verlet's rule and held together by relaxed lengths (Jakobsen, "Advanced Character
/// Physics", 2001). The top row is pinned. Pure but for emit(); the same steps give the same bits.
class Cloth {
  public:
    explicit Cloth(const Banner& banner);

    void step(float seconds);
    /// Triangles with normals towards both sides, in world space.
    void emit() const;
    /// Row by row from the top.
    [[nodiscard]] const std::vector<Vec3>& points() const { return now_; }
    /// Greatest stretch of a thread: its length over that at rest.
    [[nodiscard]] float stretch() const;

  private:
    [[nodiscard]] std::uint32_t index(std::uint32_t row, std::uint32_t column) const {
        return row * (cells_ + 1) + column;
    }
    void relax(std::uint32_t a, std::uint32_t b, float length);
    void relaxAll();
    [[nodiscard]] Vec3 normal(std::uint32_t row, std::uint32_t column) const;

    std::uint32_t cells_, iterations_;
    float across_, down_, slant_;  ///< lengths of threads at rest, metres
    Vec3 wind_;                    ///< unit, through the banner
    float time_ = 0.0F;
    std::vector<Vec3> now_, before_;
};

}  // namespace sluice::host
