// SPDX-License-Identifier: MIT
// What the launcher tells the payload: lines "key value ..." in an environment variable. Pure.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sluice/plugin.h"
#include "tracker/frame_tracker.hpp"

namespace sluice::inject {

using Triple = std::array<float, 3>;

/// A box of water at the start.
struct WaterBlock {
    Triple low{}, high{}, velocity{};
};

/// Where water comes from and what it may fill. Metres.
struct WaterPlan {
    bool in_view = true;  ///< placed before the eye of the first frame that has fluid; else in the program's world
    float units_per_metre = 0;  ///< of the program; 0: from the distance of what is seen
    std::optional<Triple> up;   ///< of the program's world; none: +y or +z, as the first eye is level
    float radius = 0.05F;       ///< of a particle
    Triple low{-1, 0, -1}, high{1, 2, 1};
    Triple gravity{0, -9.81F, 0};
    std::uint32_t iterations = 4;
    float viscosity = 0.02F, vorticity = 0;
    std::vector<WaterBlock> blocks;  ///< none, and no emitter: a column at the left wall
    std::vector<SluiceEmitter> emitters;
    std::uint32_t from_frame = 0;     ///< before it there is no fluid, and the eye of that frame is the first
    std::uint32_t max_particles = 0;  ///< at which emitters stop; 0: the library's choice
    std::uint32_t depth_scale = 4;    ///< pixels each way of the program's depth that are one as a solid; 0: it is none
    float depth_thickness =
        0;  ///< metres that what is seen is deep to who comes round its edge; 0: the diagonal of the box
};

struct Settings {
    bool children = false;      ///< processes that the program starts get the shim, too
    std::string shim;           ///< its file
    bool off = false;           ///< no fluid: watch only
    bool audit = false;         ///< compare the GL state before and after our work
    std::string report;         ///< folder to write the report into; empty: none
    double step = 0;            ///< seconds per frame; 0: the clock's
    bool same_process = false;  ///< no renderer process of its own
    float start_deadline = 20;  ///< seconds that a call of the renderer's start may take
    std::string plugin;
    TrackerRules rules;
    WaterPlan water;
    std::optional<SluiceFluid> look;
    std::optional<SluiceSky> sky;
};

[[nodiscard]] std::string printSettings(const Settings& settings);
/// Unknown keys and values that are none keep the default: program and payload come from one installation.
[[nodiscard]] Settings parseSettings(std::string_view text);

}  // namespace sluice::inject
