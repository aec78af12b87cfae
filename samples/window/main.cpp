// SPDX-License-Identifier: MIT
// An engine as they were in 2004, in a window of its own, and water in it.
#include <SDL.h>
#include <SDL_opengl.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "draw.hpp"
#include "fluid.hpp"
#include "input.hpp"
#include "options.hpp"
#include "panel.hpp"
#include "picture.hpp"
#include "window.hpp"
#include "world.hpp"

namespace window {
namespace {

constexpr double kFixedStep = 1.0 / 30.0;  // s, of a frame of --frames and of the step key
constexpr int kNoRenderer = 3, kNoPicture = 4;

int fail(int code, const std::string& why) {
    std::fprintf(stderr, "sluice_window: %s\n", why.c_str());
    return code;
}

/// What goes from frame to frame.
struct Program {
    const Options& options;
    Window& window;
    Panel& panel;
    WorldPainter& painter;
    Fluid& fluid;
    Controls controls{};
    Orbit orbit{};
    Mouse mouse{};
    glm::ivec2 size{0}, told{0};  ///< of the drawable; and as the fluid knows it
    double time = 0.0;            ///< of the fluid, s
    std::uint64_t frame = 0;
    FrameTimes times{};
    std::string failure{};
};

void hearEvents(Program& p) {
    SDL_Event event;
    while (SDL_PollEvent(&event) != 0) {
        p.panel.hear(event);
        heed(event, p.orbit, p.mouse, p.controls);
    }
    p.size = p.window.size();
    if (p.controls.restart) {
        p.controls.restart = false;
        p.fluid.restart();
    }
}

void pour(Program& p) {
    p.fluid.pour(p.mouse.pours ? hit(rayThrough(p.orbit, p.size, p.mouse.at)) : std::nullopt);
}

void advance(Program& p, double passed) {
    if (!p.controls.paused) {
        p.time += p.options.frames > 0 ? kFixedStep : passed;
    } else if (p.controls.step) {
        p.time += kFixedStep;
    }
    p.controls.step = false;
}

/// Says on stdout what the picture shows.
void takePicture(Program& p, const std::filesystem::path& path) {
    if (std::string why = writeScreenshot(path, p.size); !why.empty()) {
        (void)fail(kNoPicture, why);
        p.failure = std::move(why);
        return;
    }
    const SluiceStatistics s = p.fluid.statistics();
    std::printf("%s: %dx%d, frame %llu, %u particles, camera at %.1f and %.1f degrees, %.2f m, view %u\n", path.c_str(),
                p.size.x, p.size.y, static_cast<unsigned long long>(p.frame), s.particles,
                static_cast<double>(p.orbit.azimuth), static_cast<double>(p.orbit.elevation),
                static_cast<double>(p.orbit.distance), p.fluid.settings.look.view);
    std::fflush(stdout);
}

bool last(const Program& p) {
    return p.controls.quit || (p.options.frames > 0 && p.frame >= p.options.frames);
}

void drawFrame(Program& p) {
    if (p.size != p.told) {
        p.fluid.resize(p.size);
        p.told = p.size;
    }
    pour(p);
    p.fluid.begin(p.orbit, p.size, p.time);
    p.painter.draw(p.orbit, p.size);
    p.fluid.end();
    p.panel.draw(p.fluid, p.controls, p.times);
    ++p.frame;
    if (p.controls.screenshot) {
        p.controls.screenshot = false;
        takePicture(p, freeName());
    }
    if (last(p) && !p.options.screenshot.empty()) {
        takePicture(p, p.options.screenshot);
    }
    p.window.swap();
}

int loop(Program& p) {
    p.controls.panel = p.options.panel;
    Uint64 before = SDL_GetPerformanceCounter();
    while (!last(p)) {
        if (p.window.hidden()) {
            SDL_WaitEventTimeout(nullptr, 100);
        }
        hearEvents(p);
        const Uint64 now = SDL_GetPerformanceCounter();
        const double passed = static_cast<double>(now - before) / static_cast<double>(SDL_GetPerformanceFrequency());
        before = now;
        if (p.window.hidden() && !p.controls.quit) {
            continue;
        }
        p.times.frame_seconds += 0.1 * (passed - p.times.frame_seconds);
        advance(p, passed);
        drawFrame(p);
    }
    if (!p.failure.empty()) {
        return kNoPicture;
    }
    if (const SluiceStatistics s = p.fluid.statistics(); s.frames_without > 0) {
        return fail(kNoRenderer, std::to_string(s.frames_without) + " frames were drawn without fluid: " +
                                     (p.fluid.trouble().empty() ? "the log says why" : p.fluid.trouble()));
    }
    return 0;
}

int run(const Options& options) {
    std::string why;
    const std::unique_ptr<Window> window = Window::open(options, why);
    if (window == nullptr) {
        return fail(4, why);
    }
    const std::unique_ptr<Fluid> fluid = Fluid::create(options, window->size(), why);
    if (fluid == nullptr) {
        return kNoRenderer;  // the log has the line
    }
    WorldPainter painter(fluid->sky());
    Panel panel(window->handle(), window->context());
    Program program{options, *window, panel, painter, *fluid};
    return loop(program);
}

}  // namespace
}  // namespace window

int main(int argc, char** argv) {
    const window::Parsed parsed = window::parse(argc, argv);
    return parsed.options ? window::run(*parsed.options) : parsed.code;
}
