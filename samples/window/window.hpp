// SPDX-License-Identifier: MIT
// A window of SDL with an OpenGL 2.1 context.
#pragma once

#include <SDL.h>

#include <glm/vec2.hpp>
#include <memory>
#include <string>

#include "options.hpp"

namespace window {

class Window {
  public:
    /// On failure one line in `why`, and the pointer empty.
    [[nodiscard]] static std::unique_ptr<Window> open(const Options& options, std::string& why);
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    ~Window();

    [[nodiscard]] SDL_Window* handle() const { return window_; }
    [[nodiscard]] SDL_GLContext context() const { return context_; }
    /// Pixels of the drawable.
    [[nodiscard]] glm::ivec2 size() const;
    /// Nothing of it can be seen, and drawing would be in vain.
    [[nodiscard]] bool hidden() const;
    void swap() const { SDL_GL_SwapWindow(window_); }

  private:
    Window() = default;
    SDL_Window* window_ = nullptr;
    SDL_GLContext context_ = nullptr;
};

}  // namespace window
