// SPDX-License-Identifier: MIT
// From a scene to what it asks of the renderer.
#pragma once

#include <cstdint>

#include "sluice/plugin.h"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

[[nodiscard]] SluiceSceneNeeds sceneNeeds(const scene::Scene& scene, scene::Size size, std::uint32_t particles,
                                          std::uint32_t outputs);

}  // namespace sluice::cli
