// SPDX-License-Identifier: MIT
// The transfer functions between what GL keeps and what files hold.
#pragma once

namespace sluice::cli {

/// IEC 61966-2-1 decoding of one channel; encoded in [0,1].
[[nodiscard]] float srgbToLinear(float encoded);

/// Metres in front of the eye of an OpenGL window depth under a perspective with these planes (glFrustum's z row,
/// solved for the eye's z). +infinity at depth 1, where nothing was drawn.
[[nodiscard]] float linearDepth(float window_depth, float near_plane, float far_plane);

}  // namespace sluice::cli
