// SPDX-License-Identifier: MIT
// An engine's matrices as the renderer takes them.
#pragma once

#include <array>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

using Matrix = std::array<float, 16>;

/// From clip space to what is in the depth buffer.
struct DepthMapping {
    bool zero_to_one = false;                ///< the engine's clip space has z in [0, w] (glClipControl)
    std::array<float, 2> range{0.0F, 1.0F};  ///< glDepthRange
};

/// Pure. The projection comes out as one that has the same depths with the mapping that OpenGL begins with. Fails
/// unless it is a perspective one that looks down -z with 0 < near < far; far may be infinite. A view that scales, all
/// axes alike, is of a world whose unit is no metre: the scale is taken out of both, the picture stays.
[[nodiscard]] Result<SluiceCamera> cameraOf(const Matrix& view, const Matrix& projection, const DepthMapping& depth);

/// The two matrices of the fixed function, view first.
[[nodiscard]] Result<std::array<Matrix, 2>> matricesOfContext();

/// Whether glClipControl has chosen [0, w].
[[nodiscard]] bool clipsZeroToOne();

[[nodiscard]] std::array<float, 2> depthRange();

/// Fails if what is nearer has the larger depth by the engine's own depth test, whatever its matrices say.
[[nodiscard]] Status checkDepthTest();

}  // namespace sluice::host
