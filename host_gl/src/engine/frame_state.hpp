// SPDX-License-Identifier: MIT
// The fixed-function state in which the engine draws its frame: saved, set and given back.
#pragma once

#include "engine/colour.hpp"
#include "sluice/host_gl/engine.hpp"
#include "sluice/plugin.h"

namespace sluice::host {

/// One level of every matrix stack that the frame writes, and of the attribute stack.
class FrameScope {
  public:
    FrameScope();
    FrameScope(const FrameScope&) = delete;
    FrameScope& operator=(const FrameScope&) = delete;
    ~FrameScope();
};

/// Everything that the frame relies on, whatever state the caller was in.
void setDefaults();
/// Sun, open sky and what the paving throws back. The modelview matrix is the view.
void setLights(const SluiceSky& sky, const EngineScene& scene);
void setFog(const SluiceSky& sky, float density);
/// In encoded values; what lies beyond everything has it.
[[nodiscard]] Vec3 horizonColour(const SluiceSky& sky);

}  // namespace sluice::host
