// SPDX-License-Identifier: MIT
// What the scene is made of, sorted by the texture that it wears. Call while a display list is being compiled.
#pragma once

#include "sluice/host_gl/engine.hpp"

namespace sluice::host {

void emitPaving(const EngineScene& scene);
void emitPoolFloors(const EngineScene& scene);
void emitPoolWalls(const EngineScene& scene);
void emitAshlar(const EngineScene& scene);     ///< outer faces of the basins
void emitLimestone(const EngineScene& scene);  ///< coping, plinths, capitals, the top of the enclosure
void emitShafts(const EngineScene& scene);
void emitEnclosure(const EngineScene& scene);
void emitCrates(const EngineScene& scene);
void emitContacts(const EngineScene& scene);  ///< soft shadows where things meet the floor
void emitCasters(const EngineScene& scene);   ///< everything that throws a shadow on the floor, in few triangles

}  // namespace sluice::host
