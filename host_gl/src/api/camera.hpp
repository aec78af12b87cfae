// SPDX-License-Identifier: MIT
// An engine's matrices as the renderer takes them.
#pragma once

#include <array>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

using Matrix = std::array<float, 16>;

/// Pure. `zero_to_one`: the engine's clip space has z in [0, w] (glClipControl). Fails unless the projection is a
/// perspective one that looks down -z with 0 < near < far; far may be infinite.
[[nodiscard]] Result<SluiceCamera> cameraOf(const Matrix& view, const Matrix& projection, bool zero_to_one);

/// The two matrices of the fixed function, view first.
[[nodiscard]] Result<std::array<Matrix, 2>> matricesOfContext();

/// Whether glClipControl has chosen [0, w].
[[nodiscard]] bool clipsZeroToOne();

}  // namespace sluice::host
