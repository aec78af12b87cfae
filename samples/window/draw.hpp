// SPDX-License-Identifier: MIT
// The scene as OpenGL 1.x draws it: lights, textures, display lists, matrices on the stacks.
#pragma once

#include "orbit.hpp"
#include "sluice/sluice.h"

namespace window {

/// Everything belongs to the context that was current when it was made, which is to be current in every call.
class WorldPainter {
  public:
    explicit WorldPainter(const SluiceSky& sky);
    WorldPainter(const WorldPainter&) = delete;
    WorldPainter& operator=(const WorldPainter&) = delete;
    ~WorldPainter();

    /// Clears and draws; leaves the camera on the matrix stacks.
    void draw(const Orbit& orbit, glm::ivec2 size) const;

  private:
    SluiceSky sky_;
    unsigned stone_ = 0, wood_ = 0;  ///< textures
    unsigned list_ = 0;
};

}  // namespace window
