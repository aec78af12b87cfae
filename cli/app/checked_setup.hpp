// SPDX-License-Identifier: MIT
// A scene's simulation as the solver takes it, refused before anything is begun. Pure.
#pragma once

#include <vector>

#include "simulator/simulator.hpp"
#include "sluice/result.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// simulationSetup with the scene's meshes as solids, but where what is seen is solid instead. Whatever the solver or
/// the plugin would refuse of it is an error whose thing is the place in the scene, /simulation/emitters/0/rate, or the
/// mesh's file.
[[nodiscard]] Result<simulator::Setup> checkedSetup(const scene::Scene& scene,
                                                    const std::vector<simulator::Mesh>& meshes);

}  // namespace sluice::cli
