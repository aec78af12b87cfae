// SPDX-License-Identifier: MIT
// FluidHost as a program has it: one renderer after the other.
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "frame/call_watch.hpp"
#include "frame/check_info.hpp"
#include "frame/fault_injector.hpp"
#include "frame/kept_scene.hpp"
#include "frame/renderer_life.hpp"
#include "sluice/host_gl/fluid_host.hpp"

namespace sluice::host {

// Marks what was thrown; short, as the details are, so that it needs no memory.
inline constexpr const char* kThrown = "FluidHost";

/// Body returns a Status.
template <typename Body>
[[nodiscard]] Status withoutThrowing(Body body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return Error{SLUICE_ERROR_OUT_OF_MEMORY, kThrown, "out of memory", ""};
    } catch (const std::exception&) {
        return Error{SLUICE_ERROR_INTERNAL, kThrown, "an exception", ""};
    }
}

/// The arguments were at fault, and would be with any renderer here.
[[nodiscard]] inline bool refused(const Status& status) {
    return !status &&
           (status.error().code == SLUICE_ERROR_INVALID_ARGUMENT || status.error().code == SLUICE_ERROR_UNSUPPORTED);
}

/// One renderer after the other, and the numbers and the scene that they share.
class RecoveringHost final : public FluidHost {
  public:
    RecoveringHost(const PluginLibrary& library, FluidHostConfig config)
        : library_(library),
          config_(std::move(config)),
          watch_(config_.call_alarm_ns, config_.log, library_.limits()),
          faults_(config_.host_fault),
          recovery_(config_.recovery) {}
    RecoveringHost(const RecoveringHost&) = delete;
    RecoveringHost& operator=(const RecoveringHost&) = delete;
    ~RecoveringHost() override;

    [[nodiscard]] Status start() { return begin(); }

    [[nodiscard]] const SluiceRendererInfo& info() const override { return info_; }
    [[nodiscard]] Status resize(std::uint32_t width, std::uint32_t height) override {
        return caught([&] { return replaceImages(width, height); });
    }
    [[nodiscard]] Status setParticles(const SluiceParticles& particles) override {
        return caught([&] { return give([&] { return life_->setParticles(particles); }, particles); });
    }
    [[nodiscard]] Status setEnvironment(const SluiceEnvironment* environment) override {
        return caught([&] { return give([&] { return life_->setEnvironment(environment); }, environment); });
    }
    [[nodiscard]] Status setSimulation(const SluiceSimulation* simulation) override;
    [[nodiscard]] Status simulate(std::uint64_t value, double seconds) override;
    [[nodiscard]] Status waitForSimulation(std::uint64_t value, std::uint64_t timeout_ns) override;
    [[nodiscard]] Result<SluiceSimulationStats> simulationStats() override;
    [[nodiscard]] Result<SluiceBodies> simulationBodies(std::uint64_t value) override;
    [[nodiscard]] Status setBody(std::uint32_t body, const SluiceBodyTarget& target) override;
    [[nodiscard]] Status setFlow(const SluiceFlow& flow) override;
    [[nodiscard]] Status resetSimulation(const SluiceStart& start) override;
    [[nodiscard]] Status submit(const Screen& screen, const FrameInput& asked) override {
        return caught([&]() -> Status {
            ++without_fluid_;
            faults_.frameBegins();
            if (Status status = checkContext(); !status) {
                return status;
            }
            if (Status status = revive(); !status) {
                return status;
            }
            FrameInput input = asked;
            input.simulation = simulatedHere(asked.simulation);
            Status status = life_->submit(screen, input);
            submitted_ = status ? base_ + life_->frame() : submitted_;
            return judged(std::move(status));
        });
    }
    [[nodiscard]] Status composite(const Screen& screen) override {
        return caught([&]() -> Status {
            if (Status status = checkContext(); !status) {
                return status;
            }
            if (recovery_.down()) {
                return whileDown("composite");
            }
            Status status = life_->composite(screen);
            if (status) {
                without_fluid_ = 0;
                last_fluid_ = submitted_;
                recovery_.frameWithFluid();
            }
            return judged(std::move(status));
        });
    }
    [[nodiscard]] std::uint64_t frame() const override { return submitted_; }
    [[nodiscard]] Result<SluiceFrameStats> stats(std::uint64_t frame) override;
    [[nodiscard]] std::uint32_t texture(SluiceImageRole role) const override {
        return life_ && !recovery_.down() ? life_->texture(role) : 0;
    }
    [[nodiscard]] std::uint32_t renderers() const override { return renderers_; }
    [[nodiscard]] bool recovering() const override { return recovery_.down() && fault_told_; }

  private:
    /// Without recovery the present renderer answers for itself, whatever has become of it.
    [[nodiscard]] bool recovers() const { return config_.recovery.attempts > 0; }
    template <typename Body>
    [[nodiscard]] Status caught(Body body);
    /// Fails for good once the GL context is lost, and says so once.
    [[nodiscard]] Status checkContext();
    [[nodiscard]] Status begin();
    [[nodiscard]] Status beginWithScene();
    /// A part of the scene that the new renderer refuses, as every one after it would, goes, and that is said.
    void drop(const char* part, const Error& refusal);
    /// The simulation once more, from its initial state or what it was reset to, which stands for the value asked for
    /// last.
    [[nodiscard]] Status simulateAgain(const SluiceSimulation& simulation);
    /// What was changed since set_simulation. A part that is refused goes.
    [[nodiscard]] Status changeAgain();
    /// What the present renderer calls `value`; of what went with an earlier one, its initial state; 0 of one that it
    /// has refused.
    [[nodiscard]] std::uint64_t simulatedHere(std::uint64_t value) const;
    [[nodiscard]] Status replaceImages(std::uint32_t width, std::uint32_t height);
    template <typename Call, typename Value>
    [[nodiscard]] Status give(Call call, const Value& value);
    /// Success when there is a renderer to submit to, made now if it has to be.
    [[nodiscard]] Status revive();
    [[nodiscard]] Status tryAgain();
    /// `status` again, after a look at what it has done to the renderer.
    [[nodiscard]] Status judged(Status status);
    void fault(const Error& cause);
    [[nodiscard]] Error whileDown(const char* call) const;
    /// While there is no renderer: what the last one would refuse for its size, and the next one with it.
    [[nodiscard]] Status checkFits(const SluiceParticles& particles) const;
    template <typename Part>
    [[nodiscard]] Status checkFits(const Part* part) const {
        return checkPart(part);
    }
    void log(SluiceLogLevel level, const std::string& text);

    const PluginLibrary& library_;
    FluidHostConfig config_;
    CallWatch watch_;
    FaultInjector faults_;
    Recovery recovery_;
    KeptScene scene_;
    std::optional<SluiceFlow> flow_;  ///< of that simulation, if it was changed
    SluiceRendererInfo info_{};       ///< of the present renderer, or else of the last
    std::unique_ptr<RendererLife> life_;
    std::uint64_t base_ = 0;             ///< numbers that earlier renderers have spent
    std::uint64_t asked_ = 0;            ///< last value of simulate
    std::uint64_t reset_for_ = 0;        ///< value that the last resetSimulation was for
    std::uint64_t simulation_base_ = 0;  ///< values that went with earlier renderers
    bool simulation_dropped_ = false;    ///< a new renderer has refused it: frames are drawn without
    std::uint64_t submitted_ = 0;
    std::uint32_t renderers_ = 0;
    std::uint64_t without_fluid_ = 0;  ///< submits since the last composite
    std::uint64_t last_fluid_ = 0;     ///< the frame of that composite
    std::uint64_t down_since_ns_ = 0;
    bool try_failed_ = false;  ///< since the fault
    bool fault_told_ = false;  ///< the log has its line
    std::string cause_;
    std::string_view context_loss_;  ///< empty while there is a context
};

template <typename Call, typename Value>
Status RecoveringHost::give(Call call, const Value& value) {
    Status status = recovery_.down() ? checkFits(value) : judged(call());
    if (recovers() && !refused(status)) {
        scene_.keep(value);
    }
    return status;
}

/// What ran out in the middle of a frame may have left the hand-off half done, so that renderer is not asked again.
template <typename Body>
Status RecoveringHost::caught(Body body) {
    Status status = withoutThrowing(body);
    if (!status && status.error().thing == kThrown) {
        const Status told = withoutThrowing([&]() -> Status {
            fault(status.error());
            return {};
        });
        if (!told && life_ && recovers()) {
            recovery_.fault();  // all that is lost is its line in the log
            fault_told_ = false;
        }
    }
    return status;
}

}  // namespace sluice::host
