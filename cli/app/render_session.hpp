// SPDX-License-Identifier: MIT
// The live objects of a render: engine, screen, and fluid while it works.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/options.hpp"
#include "app/render_inputs.hpp"
#include "image/layers.hpp"
#include "report/statistics.hpp"
#include "sluice/host_gl/context.hpp"
#include "sluice/host_gl/engine.hpp"
#include "sluice/host_gl/fluid_host.hpp"
#include "sluice/host_gl/plugin_library.hpp"
#include "sluice/host_gl/screen.hpp"
#include "sluice/ledger/live.hpp"
#include "sluice/negotiate.hpp"
#include "sluice/trace.hpp"

namespace sluice::cli {

/// Declared in the order of dependence, so that destruction runs the other way with the context still current.
struct RenderSession {
    std::unique_ptr<Trace> trace;
    host::GlContext context;
    host::Screen screen;
    host::LegacyEngine engine;
    std::unique_ptr<std::atomic<std::uint32_t>> validation_messages;  ///< logged so far; any thread counts
    std::unique_ptr<ledger::LiveLedger> ledger;                       ///< null: off
    std::optional<host::PluginLibrary> library;
    std::unique_ptr<host::FluidHost> fluid;  ///< null: frames without fluid
    std::string timeline_reason;             ///< why the timeline in use was chosen
    std::int64_t animated = 1;               ///< the frame that the engine's own physics has come to
    std::vector<host::MovingBody> bodies;    ///< of a live simulation, where they were last
};

/// Context, screen and engine. The context is current from here on.
[[nodiscard]] Result<RenderSession> createSession(const RenderInputs& inputs);

/// Begins the ledger, and its log, if they were asked for.
[[nodiscard]] Status startLedger(RenderSession& session, const RenderOptions& options);

/// Loads the plugin and creates the renderer. On failure the session renders without fluid.
[[nodiscard]] Status startFluid(RenderSession& session, const RenderInputs& inputs, const RenderOptions& options);

[[nodiscard]] std::uint64_t nanoseconds(double seconds);

/// The FLUID_* roles that the layered EXR needs beyond colour and depth.
[[nodiscard]] std::uint32_t layerOutputs(const RenderOptions& options);

/// What one frame left behind.
struct FrameResult {
    FrameLayers layers;
    bool with_fluid = false;
    std::optional<Error> failure;  ///< why there is no fluid, if there should be
    std::optional<SluiceFrameStats> stats;
    double logic_ms = 0.0;                                      ///< of the engine's own physics
    double draw_ms = 0.0, submit_ms = 0.0, composite_ms = 0.0;  ///< time of the calls on the host's thread
};

/// Draws the engine's frame, then fluid into it, then reads back what the output files need.
[[nodiscard]] FrameResult renderFrame(RenderSession& session, const RenderInputs& inputs, const RenderOptions& options,
                                      std::int64_t frame);

}  // namespace sluice::cli
