// SPDX-License-Identifier: MIT
// What was asked for on the command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sluice/host_gl/fault_plan.hpp"
#include "sluice/host_gl/host_fault.hpp"
#include "sluice/plugin.h"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

struct RenderOptions {
    std::string scene, output;
    std::optional<scene::FrameRange> frames;
    std::optional<scene::Size> size;
    std::string particles;  ///< instead of the scene's path
    std::string layers, trace, plugin;
    bool json = false, quiet = false, validation = false, no_fluid = false;
    SluiceTimelineKind timeline = SLUICE_TIMELINE_AUTO;
    SluiceFormat depth_format = SLUICE_FORMAT_NONE;
    std::uint32_t image_sets = 2;
    std::optional<std::uint32_t> view;  ///< SluiceView
    bool ledger = false;
    std::string ledger_log;  ///< implies ledger
    std::optional<host::FaultPlan> fault;
    std::optional<host::HostFault> host_fault;
    bool isolate = false;
    double deadline_s = 10.0;  ///< of a CPU wait for the renderer
    std::uint64_t seed = 1;    ///< of a simulation's start
    std::uint32_t frames_in_flight = 1;
};

struct ProbeOptions {
    std::string plugin;
    bool json = false, validation = false;
};

struct ExplainOptions {
    std::string scene, particles, plugin;
    std::optional<scene::Size> size;
    bool json = false, layers = false;
};

struct GenerateOptions {
    std::uint64_t particles = 100'000;
    std::uint64_t seed = 1;
    scene::FrameRange frames;
    std::string output;
    bool quiet = false;
};

struct SimulateOptions {
    std::string scene, output;
    std::optional<scene::FrameRange> frames;
    std::uint64_t seed = 1;
    bool json = false, quiet = false, validation = false;
};

struct ConvertOptions {
    std::string input, output;
    float radius = 0.0F;  ///< for inputs that carry none
};

}  // namespace sluice::cli
