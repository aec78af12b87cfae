// SPDX-License-Identifier: MIT
#include "window.hpp"

#include <array>
#include <cstdlib>
#include <utility>

namespace window {

std::unique_ptr<Window> Window::open(const Options& options, std::string& why) {
    SDL_SetMainReady();
    // SDL would open a window that nobody sees where there is no display, and libwayland complains where there is none
    // of its own. SDL_VIDEODRIVER in the environment goes before this.
    SDL_SetHintWithPriority(SDL_HINT_VIDEODRIVER, std::getenv("WAYLAND_DISPLAY") != nullptr ? "x11,wayland" : "x11",
                            SDL_HINT_DEFAULT);
    if (SDL_Init(SDL_INIT_VIDEO) != 0) {
        const char* display = std::getenv("DISPLAY");
        why = std::string("no display: ") + SDL_GetError() + " (DISPLAY is " +
              (display != nullptr ? "'" + std::string(display) + "'" : "not set") +
              "; start it in a desktop, or under xvfb-run)";
        return nullptr;
    }
    std::unique_ptr<Window> window(new Window);
    const std::array<std::pair<SDL_GLattr, int>, 6> attributes{
        {{SDL_GL_CONTEXT_MAJOR_VERSION, 2},
         {SDL_GL_CONTEXT_MINOR_VERSION, 1},
         {SDL_GL_DOUBLEBUFFER, 1},
         {SDL_GL_DEPTH_SIZE, 24},
         {SDL_GL_MULTISAMPLEBUFFERS, options.samples > 0 ? 1 : 0},
         {SDL_GL_MULTISAMPLESAMPLES, options.samples}}};
    for (const auto& [name, value] : attributes) {
        SDL_GL_SetAttribute(name, value);
    }
    window->window_ = SDL_CreateWindow("Sluice in an old engine", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                                       options.size.x, options.size.y, SDL_WINDOW_OPENGL | SDL_WINDOW_RESIZABLE);
    if (window->window_ != nullptr) {
        SDL_SetWindowMinimumSize(window->window_, 64, 64);
        window->context_ = SDL_GL_CreateContext(window->window_);
    }
    if (window->context_ == nullptr) {
        why = std::string("no OpenGL 2.1 with ") + std::to_string(options.samples) + " samples: " + SDL_GetError();
        return nullptr;
    }
    // A run of so many frames is over when it is over.
    SDL_GL_SetSwapInterval(options.frames > 0 ? 0 : 1);
    return window;
}

Window::~Window() {
    if (context_ != nullptr) {
        SDL_GL_DeleteContext(context_);
    }
    if (window_ != nullptr) {
        SDL_DestroyWindow(window_);
    }
    SDL_Quit();
}

glm::ivec2 Window::size() const {
    glm::ivec2 size{};
    SDL_GL_GetDrawableSize(window_, &size.x, &size.y);
    return size;
}

bool Window::hidden() const {
    return (SDL_GetWindowFlags(window_) & (SDL_WINDOW_MINIMIZED | SDL_WINDOW_HIDDEN)) != 0;
}

}  // namespace window
