// SPDX-License-Identifier: MIT
// From a scene to what it asks of the renderer.
#pragma once

#include <cstdint>

#include "sluice/plugin.h"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// `mixed`: the particles of a file say which fluid each is of; those of a simulation do.
[[nodiscard]] SluiceSceneNeeds sceneNeeds(const scene::Scene& scene, scene::Size size, std::uint32_t particles,
                                          std::uint32_t outputs, bool mixed);

}  // namespace sluice::cli
