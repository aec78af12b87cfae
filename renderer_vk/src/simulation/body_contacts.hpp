// SPDX-License-Identifier: MIT
// Impacts of rigid bodies on each other and on what stands still: points against distances, one after the other.
#pragma once

#include <span>

#include "simulation/bodies.hpp"

namespace sluice::vk {

/// The spin that an angular momentum, over the mass, gives a body that is turned as in `state`.
[[nodiscard]] Vector spinOf(const Body& body, const BodyState& state, const Vector& momentum);

/// Moves bodies out of each other and of `walls`, and takes the speed with which they met. A box meets others with its
/// eight corners, a capsule with its ends, and round solids meet it with the point of theirs that is nearest to its
/// centre. Bodies with a path give way to nobody.
void resolveContacts(std::span<const Body> bodies, std::span<BodyState> states, std::span<const Solid> walls);

}  // namespace sluice::vk
