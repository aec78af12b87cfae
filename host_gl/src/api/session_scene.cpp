// SPDX-License-Identifier: MIT
// What a Session is told between frames, and what it can be asked.
#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "api/session.hpp"
#include "api/struct_sizes.hpp"
#include "api/water.hpp"
#include "frame/check_info.hpp"
#include "share/gl_errors.hpp"
#include "sluice/simulation_arrays.hpp"

namespace sluice::host {

Status Session::setWater(const SluiceWater* asked) {
    Water water;
    SluiceSimulation simulation{};
    if (asked != nullptr) {
        if (Status status = checkAbiStruct(asked, "water"); !status) {
            return status;
        }
        const SluiceWater known = readAbiStruct(*asked);
        Result<Water> made = makeWater(known);
        if (!made) {
            return made.error();
        }
        water = std::move(made).value();
        simulation = water.view();
    }
    scene_.keep(asked != nullptr ? &simulation : nullptr);
    flow_.reset();
    has_water_ = asked != nullptr;
    meets_depth_ = simulation.depth_scale != 0;
    particles_ = water.count();
    value_ = 0;
    owed_ = 0.0;
    pending_ = false;
    if (!reachable()) {
        to_go_ = 0;
        return {};  // the next frame's context gets it
    }
    const GlErrorScope errors;
    // After a scene that was refused as a whole, all of it is given again.
    Status status = start_error_ && asked != nullptr ? started(giveScene())
                                                     : host_->setSimulation(asked != nullptr ? &simulation : nullptr);
    if (!status &&
        (status.error().code == SLUICE_ERROR_INVALID_ARGUMENT || status.error().code == SLUICE_ERROR_UNSUPPORTED)) {
        // Another context's renderer would refuse it, too.
        scene_.keep(static_cast<const SluiceSimulation*>(nullptr));
        has_water_ = false;
    }
    return status;
}

Status Session::setFlow(const SluiceFlow* asked) {
    if (Status status = checkAbiStruct(asked, "flow"); !status) {
        return status;
    }
    if (!has_water_) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "sluice_set_flow", "there is no fluid", "call sluice_set_water"};
    }
    const SluiceFlow known = readAbiStruct(*asked);
    if (reachable() && !start_error_) {
        const GlErrorScope errors;
        if (Status status = host_->setFlow(known); !status) {
            return status;
        }
    }
    flow_ = flowAfter(flow_, known);
    to_go_ = 0;
    return {};
}

Status Session::setOtherLooks(std::span<const SluiceLook> looks) {
    if (looks.size() >= SLUICE_MAX_FLUIDS || (!looks.empty() && looks.data() == nullptr)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "sluice_set_other_looks",
                     fmt::format("expected at most {}, found {}{}", SLUICE_MAX_FLUIDS - 1, looks.size(),
                                 looks.data() == nullptr ? " at NULL" : ""),
                     "the first fluid's is set with sluice_set_look"};
    }
    other_looks_.assign(looks.begin(), looks.end());
    return {};
}

Status Session::setBody(std::uint32_t body, const SluiceBodyTarget* target) {
    if (Status status = checkAbiStruct(target, "target"); !status) {
        return status;
    }
    if (!active() || !reachable()) {
        return {};
    }
    const GlErrorScope errors;
    return host_->setBody(body, readAbiStruct(*target));
}

Status Session::bodies(SluiceBodies* bodies) {
    if (Status status = checkAbiStruct(bodies, "bodies"); !status) {
        return status;
    }
    const GlErrorScope errors;
    Result<SluiceBodies> found =
        active() && reachable() && value_ > 0
            ? host_->simulationBodies(0)
            : Result<SluiceBodies>(Error{SLUICE_NOT_READY, "bodies", "nothing has been simulated yet", ""});
    return found ? writeAbiStruct(bodies, found.value(), "bodies") : Status{found.error()};
}

Status Session::setEnvironment(const SluiceEnvironment* asked) {
    if (Status status = checkPart(asked); !status) {
        return status;
    }
    scene_.keep(asked);
    if (!reachable()) {
        return {};
    }
    const GlErrorScope errors;
    return start_error_ ? started(giveScene()) : host_->setEnvironment(asked);
}

Result<SluiceStatistics> Session::statistics() {
    auto out = sized<SluiceStatistics>();
    out.frames = frames_;
    out.frames_without = frames_without_;
    out.contexts = contexts_;
    out.particles = has_water_ ? particles_ : 0;
    out.end_frame_seconds = end_frame_seconds_;
    out.capture_seconds = timings_.capture;
    out.hand_over_seconds = timings_.hand_over;
    out.fluid_seconds = timings_.fluid;
    out.simulation_seconds = timings_.simulation;
    out.composite_seconds = timings_.composite;
    out.wait_seconds = wait_seconds_;
    if (!reachable()) {
        return out;
    }
    const GlErrorScope errors;
    const SluiceRendererInfo& info = host_->info();
    out.width = info.width;
    out.height = info.height;
    out.timeline = info.timeline;
    out.renderers = host_->renderers();
    const std::span name(info.capabilities.device_name);
    std::copy_n(name.begin(), std::min(name.size(), sizeof(out.device) - 1), out.device);
    if (value_ == 0) {
        return out;
    }
    if (const Result<SluiceSimulationStats> simulation = host_->simulationStats(); simulation) {
        out.steps = simulation.value().steps;
        out.simulation_failed = simulation.value().failed;
        out.particles = simulation.value().particle_count;
        out.last_simulation_seconds = static_cast<double>(simulation.value().last_busy_ns) * 1e-9;
    }
    if (drawn_ == 0 || host_->recovering()) {
        return out;
    }
    if (const Result<SluiceFrameStats> frame = host_->stats(drawn_); frame) {
        out.cpu_copy_bytes = frame.value().cpu_copy_bytes;
        out.upload_bytes = frame.value().upload_bytes;
        out.pass_count = std::min(frame.value().pass_count, SLUICE_MAX_PASSES);
        std::copy_n(frame.value().passes, out.pass_count, out.passes);
    }
    return out;
}

SluiceResult Session::told(const Status& status, Once once) {
    if (status) {
        return SLUICE_OK;
    }
    if (status.error().code > 0) {
        return status.error().code;  // not yet is no failure
    }
    last_error_ = status.error().message();
    // The FluidHost itself tells of a renderer that it replaces, with what it is about to do.
    const bool known = host_ != nullptr && host_->recovering();
    if (told_.isNews(last_error_, once) && !known) {
        log_(SLUICE_LOG_ERROR, last_error_);
    }
    return status.error().code;
}

}  // namespace sluice::host
