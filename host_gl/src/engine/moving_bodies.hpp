// SPDX-License-Identifier: MIT
// Shapes of bodies that are drawn where they are in a frame.
#pragma once

#include "sluice/host_gl/engine.hpp"

namespace sluice::host {

/// Multiplies the matrix by the body's pose.
void applyPose(const MovingBody& body);
/// A ball, or an upright capsule, about the origin. Half extents in metres.
void emitRound(const Vec3& half);

}  // namespace sluice::host
