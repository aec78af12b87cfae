// SPDX-License-Identifier: MIT
// The controls and the figures over the picture (Dear ImGui, drawn by OpenGL 2).
#pragma once

#include <SDL.h>

#include "fluid.hpp"

namespace window {

/// What the whole program is told, by keys and by the panel alike.
struct Controls {
    bool paused = false;
    bool step = false;  ///< one frame of a paused fluid
    bool restart = false;
    bool screenshot = false;
    bool panel = true;
    bool quit = false;
};

struct FrameTimes {
    double frame_seconds = 0.0;  ///< mean of the last ones, the engine's drawing included
};

/// The window and its context must outlive it.
class Panel {
  public:
    Panel(SDL_Window* window, SDL_GLContext context);
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;
    ~Panel();

    void hear(const SDL_Event& event);
    /// The mouse is over it, or it holds the keyboard: what the event says is not for the scene.
    [[nodiscard]] static bool takesMouse();
    [[nodiscard]] static bool takesKeys();
    /// Draws; what is clicked goes into `fluid.settings` and `controls`.
    void draw(Fluid& fluid, Controls& controls, const FrameTimes& times);

  private:
    SluiceStatistics shown_{};
    Uint32 shown_at_ = 0;  ///< ms; the figures change twice a second, so that they can be read
};

}  // namespace window
