// SPDX-License-Identifier: MIT
// HOST_DEPTH as linear R32F, for drivers on which no depth format can be shared.
#pragma once

#include <array>
#include <cstdint>

#include "compositor/gl_program.hpp"
#include "sluice/result.hpp"

namespace sluice::host {

/// Coefficients of linear = (n0 + n1 e) / (d0 + d1 e) with e = 1 - window depth, in metres in front of the eye.
///
/// From the OpenGL projection, ndc = (P10 z + P14) / (P11 z + P15) (column-major, z along the eye's axis), solved for
/// -z with ndc = 1 - 2 e. In e nothing cancels near the far plane: 1 - depth is exact in binary for depth in [0.5, 1],
/// and d0 = P11 - P10 is formed in double precision.
struct LinearDepthMap {
    double n0, n1, d0, d1;
};
[[nodiscard]] LinearDepthMap linearDepthMap(const std::array<float, 16>& projection);

/// Copies depth into a texture of its own on the GPU and runs one full-screen pass over it. Move-only; freed with the
/// GL context current.
class LinearDepthPass {
  public:
    [[nodiscard]] static Result<LinearDepthPass> create(std::uint32_t width, std::uint32_t height);
    LinearDepthPass(LinearDepthPass&& other) noexcept;
    LinearDepthPass& operator=(LinearDepthPass&& other) noexcept;
    LinearDepthPass(const LinearDepthPass&) = delete;
    LinearDepthPass& operator=(const LinearDepthPass&) = delete;
    ~LinearDepthPass();

    /// Writes metres into `target`, an R32F texture of this size; +infinity where depth is 1. Relative error against
    /// the double-precision formula at the same depth and projection: at most 1e-6. Leaves all GL state as found.
    void run(std::uint32_t screen_framebuffer, std::uint32_t target, const std::array<float, 16>& projection) const;

  private:
    LinearDepthPass() = default;
    void swap(LinearDepthPass& other) noexcept;

    GlProgram program_;
    std::int32_t coefficients_ = -1, infinity_ = -1, texel_ = -1;
    std::uint32_t depth_ = 0, framebuffer_ = 0, width_ = 0, height_ = 0;
};

}  // namespace sluice::host
