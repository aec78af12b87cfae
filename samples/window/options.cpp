// SPDX-License-Identifier: MIT
#include "options.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cstdio>
#include <map>

namespace window {
namespace {

constexpr const char* kKeys =
    "Mouse: left button pours, right or middle button turns the camera, wheel zooms.\n"
    "Keys:  space pauses, N steps, R begins again, H hides the panel, F12 writes a screenshot, Escape ends.\n"
    "Exit codes: 0 done; 1 wrong command line; 3 frames were drawn without fluid, or there is no renderer;\n"
    "4 no display, no OpenGL, or a picture that cannot be written.";

/// "960x600"; empty if it is none.
std::optional<glm::ivec2> sizeOf(const std::string& text) {
    glm::ivec2 size{};
    const char* end = text.data() + text.size();
    const auto [x, wide] = std::from_chars(text.data(), end, size.x);
    if (wide != std::errc() || x == end || *x != 'x') {
        return std::nullopt;
    }
    const auto [rest, high] = std::from_chars(x + 1, end, size.y);
    if (high != std::errc() || rest != end || size.x < 64 || size.y < 64 || size.x > 8192 || size.y > 8192) {
        return std::nullopt;
    }
    return size;
}

}  // namespace

Parsed parse(int argc, char** argv) {
    Options options;
    std::string size = "960x600";
    CLI::App app("A window with an engine of the fixed-function days, and water in it through sluice/sluice.h.",
                 "sluice_window");
    app.footer(kKeys);
    app.add_option("--size", size, "of the window, WxH, 64 to 8192 a side [960x600]");
    const std::map<std::string, Preset> presets{{"dam", Preset::Dam}, {"pool", Preset::Pool}, {"empty", Preset::Empty}};
    std::string scene = "dam";
    app.add_option("--scene", scene, "dam, pool or empty: what fluid there is at the start [dam]")->option_text("NAME");
    app.add_option("--radius", options.radius, "of a particle in metres, 0.02 to 0.2 [0.05]")
        ->check(CLI::Range(0.02F, 0.2F));
    app.add_option("--frames", options.frames, "end after so many, of a thirtieth of a second each whatever they take");
    app.add_option("--screenshot", options.screenshot, "write the last frame as PNG");
    app.add_option("--samples", options.samples, "of the window's multisampling: 0, 2, 4 or 8 [0]")
        ->check(CLI::IsMember({0, 2, 4, 8}));
    app.add_flag("--isolate", options.isolate, "the renderer in a process of its own: if it crashes, the window stays");
    bool hidden = false;
    app.add_flag("--no-panel", hidden, "begin without the panel");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            std::fputs(app.help().c_str(), stdout);
            return {std::nullopt, 0};
        }
        std::fprintf(stderr, "sluice_window: %s (--help lists the options)\n", error.what());
        return {std::nullopt, 1};
    }
    const std::optional<glm::ivec2> asked = sizeOf(size);
    if (!asked) {
        std::fprintf(stderr, "sluice_window: --size: expected WxH of 64 to 8192 a side, found '%s'\n", size.c_str());
        return {std::nullopt, 1};
    }
    const auto preset = presets.find(scene);
    if (preset == presets.end()) {
        std::fprintf(stderr, "sluice_window: --scene: expected dam, pool or empty, found '%s'\n", scene.c_str());
        return {std::nullopt, 1};
    }
    options.preset = preset->second;
    options.size = *asked;
    options.panel = !hidden;
    return {options, 0};
}

}  // namespace window
