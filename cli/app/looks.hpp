// SPDX-License-Identifier: MIT
// How each of a scene's fluids looks, and which of them a particle of a file is. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "sluice/particles/particles.hpp"
#include "sluice/plugin.h"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// The look of the first.
[[nodiscard]] SluiceFluid firstLook(const scene::Scene& scene);
/// Those of the others; none where all are alike.
[[nodiscard]] std::vector<SluiceLook> otherLooks(const scene::Scene& scene);

/// Pure. The number of the fluid whose colour is nearest to three floats of linear RGB, of two the first. There is one.
[[nodiscard]] std::uint32_t nearestFluid(const std::vector<scene::FluidKind>& fluids, const float* colour);

/// The fluid of each particle: that whose colour is nearest to the particle's, as `sluice simulate` writes it. None
/// where the particles have no colours or the scene has no two fluids.
[[nodiscard]] std::vector<std::uint32_t> fluidsOf(const particles::ParticleSet& set, const scene::Scene& scene);

}  // namespace sluice::cli
