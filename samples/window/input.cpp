// SPDX-License-Identifier: MIT
#include "input.hpp"

namespace window {
namespace {

void press(SDL_Keycode key, Controls& controls) {
    switch (key) {
        case SDLK_SPACE:
            controls.paused = !controls.paused;
            break;
        case SDLK_n:
            controls.step = true;
            break;
        case SDLK_r:
            controls.restart = true;
            break;
        case SDLK_h:
            controls.panel = !controls.panel;
            break;
        case SDLK_F12:
            controls.screenshot = true;
            break;
        case SDLK_ESCAPE:
            controls.quit = true;
            break;
        default:
            break;
    }
}

void button(const SDL_MouseButtonEvent& event, bool down, Mouse& mouse) {
    (event.button == SDL_BUTTON_LEFT ? mouse.pours : mouse.turns) = down;
}

}  // namespace

void heed(const SDL_Event& event, Orbit& orbit, Mouse& mouse, Controls& controls) {
    switch (event.type) {
        case SDL_QUIT:
            controls.quit = true;
            break;
        case SDL_KEYDOWN:
            if (!Panel::takesKeys() && event.key.repeat == 0) {
                press(event.key.keysym.sym, controls);
            }
            break;
        case SDL_MOUSEBUTTONDOWN:
            if (!Panel::takesMouse()) {
                button(event.button, true, mouse);
            }
            break;
        case SDL_MOUSEBUTTONUP:
            button(event.button, false, mouse);
            break;
        case SDL_MOUSEMOTION:
            mouse.at = {event.motion.x, event.motion.y};
            if (mouse.turns) {
                orbit = dragged(orbit, {static_cast<float>(event.motion.xrel), static_cast<float>(event.motion.yrel)});
            }
            break;
        case SDL_MOUSEWHEEL:
            if (!Panel::takesMouse()) {
                orbit = zoomed(orbit, static_cast<float>(event.wheel.y));
            }
            break;
        default:
            break;
    }
}

}  // namespace window
