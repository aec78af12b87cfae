// SPDX-License-Identifier: MIT
// The command line.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

namespace window {

/// What fluid there is at the start.
enum class Preset : unsigned char { Dam, Pool, Empty };

struct Options {
    glm::ivec2 size{960, 600};
    Preset preset = Preset::Dam;
    float radius = 0.05F;      ///< of a particle, metres
    std::uint64_t frames = 0;  ///< after which it ends; 0: when the window is closed
    std::string screenshot;    ///< of the last frame; empty: none
    int samples = 0;           ///< of the window
    bool isolate = false;      ///< the renderer in a process of its own
    bool panel = true;
};

/// The code to end with where there is nothing to run: 0 after --help, 1 after one line on stderr.
struct Parsed {
    std::optional<Options> options;
    int code = 0;
};
[[nodiscard]] Parsed parse(int argc, char** argv);

}  // namespace window
