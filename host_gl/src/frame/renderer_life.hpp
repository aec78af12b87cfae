// SPDX-License-Identifier: MIT
// One renderer from its creation to its end, and the frames of that time.
#pragma once

#include <cstdint>
#include <optional>

#include "compositor/composite.hpp"
#include "compositor/gpu_timer.hpp"
#include "frame/call_watch.hpp"
#include "frame/connection.hpp"
#include "frame/fault_injector.hpp"
#include "sluice/host_gl/fluid_host.hpp"

namespace sluice::host {

/// Frames are counted from 1, as the renderer counts them. Every call means what the same call of FluidHost means, and
/// needs the GL context of start() current, as does destruction.
class RendererLife {
  public:
    /// Both must outlive the object.
    RendererLife(const FluidHostConfig& config, CallWatch& watch, FaultInjector& faults)
        : link_(config), watch_(watch), faults_(faults), timer_(config.trace) {}
    RendererLife(const RendererLife&) = delete;
    RendererLife& operator=(const RendererLife&) = delete;
    ~RendererLife();

    [[nodiscard]] Status start(const PluginLibrary& library);
    [[nodiscard]] Status resize(std::uint32_t width, std::uint32_t height);
    [[nodiscard]] Status setParticles(const SluiceParticles& particles);
    [[nodiscard]] Status setEnvironment(const SluiceEnvironment* environment);
    [[nodiscard]] Status setSimulation(const SluiceSimulation* simulation);
    [[nodiscard]] Status simulate(std::uint64_t value, double seconds);
    [[nodiscard]] Status waitForSimulation(std::uint64_t value, std::uint64_t timeout_ns);
    [[nodiscard]] Result<SluiceSimulationStats> simulationStats();
    [[nodiscard]] Result<SluiceBodies> simulationBodies(std::uint64_t value);
    [[nodiscard]] Status setBody(std::uint32_t body, const SluiceBodyTarget& target);
    [[nodiscard]] Status setFlow(const SluiceFlow& flow);
    [[nodiscard]] Status resetSimulation(const SluiceStart& start);
    [[nodiscard]] Status submit(const Screen& screen, const FrameInput& input);
    [[nodiscard]] Status composite(const Screen& screen);
    [[nodiscard]] Result<SluiceFrameStats> stats(std::uint64_t frame);
    [[nodiscard]] std::uint32_t texture(SluiceImageRole role) const;

    [[nodiscard]] const SluiceRendererInfo& info() const { return link_.info; }
    [[nodiscard]] std::uint64_t frame() const { return submitted_; }
    /// Numbers of frames that were given away, whether the renderer took them or not.
    [[nodiscard]] std::uint64_t numbersSpent() const { return next_ - 1; }
    /// Why only another renderer can bring fluid again; empty while this one can.
    [[nodiscard]] const std::optional<Error>& fault() const { return fault_; }
    /// The GL context is lost: nothing more is waited for.
    void contextLost() { gl_lost_ = true; }
    /// What is logged goes where the renderer's own lines go.
    void log(SluiceLogLevel level, std::string_view text) { link_.services.log(level, text); }

  private:
    /// Remembers that the device is lost: from then on no GL wait is recorded for it (docs/protocol.md).
    void noteLoss(const Error& error);
    /// `status` again. A failure that is no caller's costs a strike, and the last strike is a fault.
    [[nodiscard]] Status strike(Status status);
    /// `status` again. A failure that is no caller's is a fault.
    [[nodiscard]] Status fatal(Status status);
    /// The same for a part of the scene, which a renderer may refuse and live on.
    [[nodiscard]] Status given(Status status);
    /// nullptr without a ledger.
    [[nodiscard]] ledger::HandOffFeed* feed() { return link_.feed ? &*link_.feed : nullptr; }
    void tellSubmit(std::uint64_t frame);
    /// False when nothing may be waited for any more.
    [[nodiscard]] bool glMayFinish() const;
    /// Waits until the GL command stream has ended and records its passes.
    void finishGl();
    [[nodiscard]] Status checkScreen(const Screen& screen, const char* call) const;
    void capture(const Screen& screen, const SluiceCamera& camera, std::uint64_t frame);
    [[nodiscard]] Status handOver(const Screen& screen, const FrameInput& input);
    [[nodiscard]] Status waitFor(std::uint64_t value, const std::vector<std::uint32_t>& textures);
    [[nodiscard]] Status callRenderer(const FrameInput& input, std::uint64_t frame);
    void draw(const Screen& screen, std::uint64_t frame);

    Connection link_;
    CallWatch& watch_;
    FaultInjector& faults_;
    GpuTimer timer_;
    Compositor compositor_;
    std::uint64_t next_ = 1;       ///< number of the next frame
    std::uint64_t submitted_ = 0;  ///< the last frame that the renderer accepted
    bool composable_ = false;      ///< that frame waits for its composite
    bool usable_ = false;          ///< false after a failed resize
    bool lost_ = false;            ///< the renderer has said that its device is lost
    bool gl_lost_ = false;
    std::uint32_t strikes_ = 0;  ///< frames in a row without fluid for the renderer's sake
    std::optional<Error> fault_;
};

}  // namespace sluice::host
