// SPDX-License-Identifier: MIT
#include "sluice/defaults.hpp"

#include "sluice/scene/scene.hpp"

namespace sluice::scene {

SluiceFluid defaultFluid() {
    return sluice::defaultFluid();
}

SluiceSky defaultSky() {
    return sluice::defaultSky();
}

}  // namespace sluice::scene
