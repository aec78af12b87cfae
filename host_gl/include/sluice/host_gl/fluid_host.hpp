// SPDX-License-Identifier: MIT
// The host's half of a Sluice frame: capture the GBuffer, hand it over, composite what comes back.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "sluice/host_gl/fault_plan.hpp"
#include "sluice/host_gl/host_fault.hpp"
#include "sluice/host_gl/plugin_library.hpp"
#include "sluice/host_gl/recovery.hpp"
#include "sluice/host_gl/screen.hpp"
#include "sluice/negotiate.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "sluice/trace.hpp"

namespace sluice::ledger {
class LiveLedger;
}

namespace sluice::host {

struct FluidHostConfig {
    std::uint32_t width = 0, height = 0;
    std::uint32_t image_sets = 2;
    SluiceTimelineKind timeline = SLUICE_TIMELINE_AUTO;
    std::uint32_t outputs = 0;  ///< FLUID_* roles beyond colour and depth, SLUICE_ROLE_BIT
    SluiceFormat host_depth = SLUICE_FORMAT_NONE;
    bool validation = false;
    std::uint64_t wait_timeout_ns = 10'000'000'000ULL;
    Trace* trace = nullptr;  ///< must outlive the FluidHost; nullptr: tracing off
    /// Gets every step of the hand-off as it is taken (sluice/ledger/live.hpp), and the log the chain of waits when one
    /// passes its deadline. Must outlive the FluidHost, and is of no other; nullptr: off.
    ledger::LiveLedger* ledger = nullptr;
    std::optional<FaultPlan> fault;       ///< for tests: one thing that goes wrong
    std::optional<HostFault> host_fault;  ///< likewise; over every renderer of the FluidHost
    RecoveryPolicy recovery;
    /// A call into the renderer that has not come back by then is logged, once, by a thread of the host's own; a call
    /// that may wait gets that time in addition. 0: there is no such thread.
    std::uint64_t call_alarm_ns = 10'000'000'000ULL;
    /// Called on any thread. It must not wait for the thread that renders: that one may be waiting for it.
    std::function<void(SluiceLogLevel, std::string_view)> log;
};

/// Everything that changes from frame to frame.
struct FrameInput {
    SluiceCamera camera{};
    SluiceSky sky{};
    SluiceFluid fluid{};
    /// Of the fluids after the first, SLUICE_MAX_FLUIDS - 1 at most. Must last until submit() returns.
    std::span<const SluiceLook> other_looks{};
    std::uint32_t outputs = 0;
    std::uint32_t flags = 0;       ///< SluiceFrameFlags
    std::uint64_t simulation = 0;  ///< the value of the simulation to draw; 0: the particles of setParticles
    /// CLOCK_MONOTONIC when the engine began to draw this frame, or 0: with it, the ledger's log shows that draw.
    std::uint64_t draw_began_ns = 0;
};

/// Owns one renderer, the imported images and the host's end of the timelines. Not thread-safe; every call needs the GL
/// context of create() current, and so does destruction, which waits until GL has finished. Every call leaves the GL
/// state as it found it. No call throws: memory that runs out is SLUICE_ERROR_OUT_OF_MEMORY.
///
/// A renderer that has become useless (its device is lost, a resize found no memory, deadlines pass in a row ...) is
/// destroyed and created again by submit(), as FluidHostConfig::recovery says; that submit() takes as long as create()
/// does. Until then submit() fails, at once, and the frames are the host's alone. The new renderer gets the particles,
/// the environment and the simulation that were set last, of which the FluidHost keeps a copy; what it refuses of them
/// is dropped. What had flowed is lost with the renderer: the simulation begins again from its initial state, or from
/// what it was last reset to. What happens is logged, a line each.
///
/// A GL context that is lost (contextLoss()) ends the FluidHost: every call says so, and nothing more is asked of GL
/// but to free its objects. Make a context, and a FluidHost in it.
class FluidHost {
  public:
    [[nodiscard]] static Result<std::unique_ptr<FluidHost>> create(const PluginLibrary& library,
                                                                   const FluidHostConfig& config);
    virtual ~FluidHost() = default;

    [[nodiscard]] virtual const SluiceRendererInfo& info() const = 0;
    [[nodiscard]] virtual Status resize(std::uint32_t width, std::uint32_t height) = 0;
    [[nodiscard]] virtual Status setParticles(const SluiceParticles& particles) = 0;
    [[nodiscard]] virtual Status setEnvironment(const SluiceEnvironment* environment) = 0;

    /// A fluid that flows inside the renderer; nullptr ends it. UNSUPPORTED if the plugin serves ABI 1.0 only.
    [[nodiscard]] virtual Status setSimulation(const SluiceSimulation* simulation) = 0;
    /// Lets it flow for `seconds` more (0: not at all) and calls the result `value`, from 1 without gaps. Returns at
    /// once: what the host does before it submits a frame of that value runs beside it. Ask for no more than
    /// frames_in_flight values ahead of the frames.
    [[nodiscard]] virtual Status simulate(std::uint64_t value, double seconds) = 0;
    /// Until the simulation has reached `value`; SLUICE_TIMEOUT.
    [[nodiscard]] virtual Status waitForSimulation(std::uint64_t value, std::uint64_t timeout_ns) = 0;
    /// Steps and times are those of the present renderer, values the caller's.
    [[nodiscard]] virtual Result<SluiceSimulationStats> simulationStats() = 0;
    /// The bodies at the end of `value`, or, of 0, of the last that has been simulated; SLUICE_NOT_READY until it has.
    /// UNSUPPORTED if the plugin serves ABI 1.1 only, as setBody is.
    [[nodiscard]] virtual Result<SluiceBodies> simulationBodies(std::uint64_t value) = 0;
    /// Where a driven body is to be at the end of the value that is asked for next.
    [[nodiscard]] virtual Status setBody(std::uint32_t body, const SluiceBodyTarget& target) = 0;
    /// How the fluid flows from the value on that is asked for next.
    [[nodiscard]] virtual Status setFlow(const SluiceFlow& flow) = 0;
    /// What the value that is asked for next begins with, at time 0. A new renderer begins with it, too.
    [[nodiscard]] virtual Status resetSimulation(const SluiceStart& start) = 0;

    /// Copies colour and depth of the screen into the next image set on the GPU, signals, and submits frame k.
    /// On failure the host's frame is untouched and the next call starts a new frame.
    [[nodiscard]] virtual Status submit(const Screen& screen, const FrameInput& input) = 0;
    /// Waits for the frame submitted last and draws the fluid into the screen with the screen's own depth test, writing
    /// depth. On failure the screen is untouched.
    [[nodiscard]] virtual Status composite(const Screen& screen) = 0;
    /// The number of the frame submitted last, 0 before the first. Numbers go on over a new renderer.
    [[nodiscard]] virtual std::uint64_t frame() const = 0;
    /// Waits for that frame.
    [[nodiscard]] virtual Result<SluiceFrameStats> stats(std::uint64_t frame) = 0;
    /// The GL texture that holds `role` in the set used last, 0 if it is not shared.
    [[nodiscard]] virtual std::uint32_t texture(SluiceImageRole role) const = 0;
    /// Renderers created so far: more than 1 when one has been lost.
    [[nodiscard]] virtual std::uint32_t renderers() const = 0;
    /// The renderer is useless, and the log has been told why and what comes next.
    [[nodiscard]] virtual bool recovering() const = 0;
};

/// Host services for calls that need no FluidHost (describe, probe_format); valid while the object lives and its GL
/// context is current.
class ProbeServices {
  public:
    explicit ProbeServices(std::function<void(SluiceLogLevel, std::string_view)> log);
    ~ProbeServices();
    ProbeServices(const ProbeServices&) = delete;
    ProbeServices& operator=(const ProbeServices&) = delete;
    [[nodiscard]] const SluiceHostServices& services() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace sluice::host
