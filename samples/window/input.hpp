// SPDX-License-Identifier: MIT
// What keys and mouse do to the scene.
#pragma once

#include <SDL.h>

#include "orbit.hpp"
#include "panel.hpp"

namespace window {

struct Mouse {
    glm::ivec2 at{0};
    bool pours = false, turns = false;
};

/// One event that is not the panel's alone. A drag that began in the scene goes on over the panel.
void heed(const SDL_Event& event, Orbit& orbit, Mouse& mouse, Controls& controls);

}  // namespace window
