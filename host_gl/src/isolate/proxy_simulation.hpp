// SPDX-License-Identifier: MIT
// The functions of an isolated renderer that are about a simulation, since ABI 1.1.
#pragma once

#include "sluice/plugin.h"

namespace sluice::host::proxy {

void addSimulation(SluiceRendererApi& table);

}  // namespace sluice::host::proxy
