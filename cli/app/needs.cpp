// SPDX-License-Identifier: MIT
#include "app/needs.hpp"

#include "app/live_fluid.hpp"
#include "app/looks.hpp"

namespace sluice::cli {

SluiceSceneNeeds sceneNeeds(const scene::Scene& scene, scene::Size size, std::uint32_t particles, std::uint32_t outputs,
                            bool mixed) {
    SluiceSceneNeeds needs{};
    needs.struct_size = sizeof(needs);
    needs.width = size.width;
    needs.height = size.height;
    needs.particle_count = particles;
    needs.has_environment_map = scene.environment.empty() ? 0 : 1;
    needs.outputs = outputs;
    needs.fluid = firstLook(scene);
    if (mixed || simulatesLive(scene)) {
        needs.other_look_count = static_cast<std::uint32_t>(otherLooks(scene).size());
    }
    if (!simulatesLive(scene) || scene.simulation.anisotropy.ratio == 0.0F) {
        needs.fluid.ellipsoids = 0;
    }
    if (!simulatesLive(scene) || scene.simulation.foam.life == 0.0F) {
        needs.fluid.foam = 0.0F;
    }
    return needs;
}

}  // namespace sluice::cli
