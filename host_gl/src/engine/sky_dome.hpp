// SPDX-License-Identifier: MIT
// The sky of plugin.h (SluiceSky), drawn per vertex.
#pragma once

#include "sluice/host_gl/engine.hpp"

namespace sluice::host {

/// The formula of SluiceSky for a unit direction, linear.
[[nodiscard]] Vec3 skyRadiance(const SluiceSky& sky, const Vec3& direction);

/// A unit sphere around the origin, seen from inside, with encodeSrgb(skyRadiance) at its vertices. The rings are
/// spaced so that interpolation between them stays within 2/255 of the formula: evenly in sqrt(d.y) above the horizon,
/// and around the sun in the square root of the smoothstep's argument. Call while a display list is being compiled.
void emitSkyDome(const SluiceSky& sky);

}  // namespace sluice::host
