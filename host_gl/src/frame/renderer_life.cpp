// SPDX-License-Identifier: MIT
#include "frame/renderer_life.hpp"

#include <epoxy/gl.h>

#include <exception>
#include <optional>
#include <utility>

#include "compositor/draw_guard.hpp"
#include "context/profile.hpp"
#include "frame/check_info.hpp"
#include "sluice/abi_sizes.hpp"
#include "timeline/timeline_events.hpp"

namespace sluice::host {

RendererLife::~RendererLife() {
    // GL's own signals must have landed before the renderer is asked to end: its queue may wait for them, and it
    // cannot know whether they are late or lost. The last frame's passes have ended then, too.
    try {
        finishGl();
    } catch (const std::exception&) {
        // GL has finished; what could not be kept of the last frame is its times.
    }
    const auto scope = watch_.during("destroy", 0);
    // A lost device, a stuck renderer and a process that was killed wait for nothing.
    link_.close(glMayFinish() && !lost_ && !fault_);
}

Status RendererLife::start(const PluginLibrary& library) {
    if (Status status = checkDrawable(); !status) {
        return status;
    }
    Result<Compositor> compositor = Compositor::create();
    if (!compositor) {
        return compositor.error();
    }
    compositor_ = std::move(compositor).value();
    const auto scope = watch_.during("create", 0);
    Status status = link_.open(library);
    usable_ = status.ok();
    return status;
}

void RendererLife::noteLoss(const Error& error) {
    if (lost_ || error.code != SLUICE_ERROR_DEVICE_LOST) {
        return;
    }
    lost_ = true;
    fault_ = error;
    if (feed() != nullptr) {
        feed()->rendererLost();
    }
}

Status RendererLife::strike(Status status) {
    if (status) {
        return status;
    }
    noteLoss(status.error());
    const std::uint32_t allowed = link_.config.recovery.strikes;
    if (++strikes_ >= allowed && !fault_) {
        fault_ = status.error();
    }
    return status;
}

Status RendererLife::fatal(Status status) {
    // A new renderer would refuse the same arguments.
    if (!status && status.error().code != SLUICE_ERROR_INVALID_ARGUMENT) {
        noteLoss(status.error());
        fault_ = status.error();
    }
    return status;
}

Status RendererLife::given(Status status) {
    // More than the device can hold: what it had it keeps, and another renderer could hold no more.
    return !status && status.error().code == SLUICE_ERROR_UNSUPPORTED ? status : fatal(std::move(status));
}

Status RendererLife::setParticles(const SluiceParticles& particles) {
    const auto scope = watch_.during("set_particles", 0);
    return given(link_.renderer.setParticles(particles));
}

Status RendererLife::setEnvironment(const SluiceEnvironment* environment) {
    const auto scope = watch_.during("set_environment", 0);
    return given(link_.renderer.setEnvironment(environment));
}

Status RendererLife::setSimulation(const SluiceSimulation* simulation) {
    const auto scope = watch_.during("set_simulation", 0);
    Status status = link_.renderer.setSimulation(simulation);
    if (status && simulation != nullptr && feed() != nullptr) {
        feed()->simulationMade(readAbiStruct(*simulation).frames_in_flight + 1);
    }
    return given(std::move(status));
}

Status RendererLife::simulate(std::uint64_t value, double seconds) {
    const auto scope = watch_.during("simulate", value);
    return given(link_.renderer.simulate(value, seconds));
}

Status RendererLife::waitForSimulation(std::uint64_t value, std::uint64_t timeout_ns) {
    const auto scope = watch_.during("simulation_wait", value, timeout_ns);
    Status status = link_.renderer.waitForSimulation(value, timeout_ns);
    if (!status) {
        noteLoss(status.error());
    }
    return status;
}

Result<SluiceSimulationStats> RendererLife::simulationStats() {
    const auto scope = watch_.during("simulation_stats", 0);
    return link_.renderer.simulationStats();
}

Result<SluiceBodies> RendererLife::simulationBodies(std::uint64_t value) {
    const auto scope = watch_.during("simulation_bodies", value);
    return link_.renderer.simulationBodies(value);
}

Status RendererLife::setBody(std::uint32_t body, const SluiceBodyTarget& target) {
    const auto scope = watch_.during("set_body", body);
    return given(link_.renderer.setBody(body, target));
}

Status RendererLife::setFlow(const SluiceFlow& flow) {
    const auto scope = watch_.during("set_flow", 0);
    return given(link_.renderer.setFlow(flow));
}

Status RendererLife::resetSimulation(const SluiceStart& start) {
    const auto scope = watch_.during("reset_simulation", 0);
    return given(link_.renderer.resetSimulation(start));
}

Result<SluiceFrameStats> RendererLife::stats(std::uint64_t frame) {
    const auto scope = watch_.during("poll", frame, link_.config.wait_timeout_ns);
    Result<SluiceFrameStats> stats = link_.renderer.stats(frame, link_.config.wait_timeout_ns);
    if (!stats) {
        noteLoss(stats.error());
    }
    timer_.collect();
    return stats;
}

std::uint32_t RendererLife::texture(SluiceImageRole role) const {
    return link_.services.images().texture(role, submitted_ == 0 ? 0 : imageSetOf(submitted_, link_.info.image_sets));
}

bool RendererLife::glMayFinish() const {
    const bool on_gpu = link_.timeline != nullptr && (link_.timeline->kind() == SLUICE_TIMELINE_NATIVE ||
                                                      link_.timeline->kind() == SLUICE_TIMELINE_BINARY);
    // A GL wait that was recorded before the device was lost might never end.
    return !(lost_ && on_gpu) && !gl_lost_ && !glGone();
}

void RendererLife::finishGl() {
    if (glMayFinish()) {
        const std::uint64_t begin = traceClock(link_.config.trace, feed());
        glFinish();
        if (feed() != nullptr) {
            feed()->glFinished(begin);
        }
    }
    if (!glGone()) {
        timer_.collect();
    }
}

Status RendererLife::resize(std::uint32_t width, std::uint32_t height) {
    if (Status status = checkExtent(width, height); !status) {
        return status;
    }
    // Nothing of the old images may be in use on this side either.
    finishGl();
    composable_ = false;
    const auto scope = watch_.during("resize", 0);
    Status status = link_.resize(width, height);
    usable_ = status.ok();
    return fatal(std::move(status));
}

}  // namespace sluice::host
