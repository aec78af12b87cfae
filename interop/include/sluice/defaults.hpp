// SPDX-License-Identifier: MIT
// How a fluid looks and flows where nobody says otherwise.
#pragma once

#include "sluice/plugin.h"

namespace sluice {

[[nodiscard]] SluiceFluid defaultFluid();
[[nodiscard]] SluiceSky defaultSky();

}  // namespace sluice
