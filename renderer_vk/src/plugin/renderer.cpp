// SPDX-License-Identifier: MIT
#include "plugin/renderer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/validation.hpp"
#include "passes/capture_depth.hpp"
#include "passes/frame_constants.hpp"
#include "plugin/agree.hpp"
#include "plugin/arguments.hpp"
#include "sluice/format.hpp"
#include "sluice/negotiate.hpp"
#include "sluice/trace.hpp"

using sluice::Error;
using sluice::Result;
using sluice::Status;
using namespace sluice::vk;

namespace {

/// How long a running frame may wait for a value that the host has promised, once the renderer has to end.
constexpr std::uint64_t kGraceNs = 500'000'000;
/// Longer than any step of a simulation that is not behind such frames.
constexpr std::uint64_t kStepNs = 10'000'000'000;

}  // namespace

Result<std::unique_ptr<SluiceRenderer>> SluiceRenderer::create(const SluiceHostServices& host,
                                                               const SluiceCreateInfo& info) {
    auto renderer = std::make_unique<SluiceRenderer>();
    renderer->host_ = host;
    DeviceRequest request;
    request.host = info.host;
    request.validation = info.validation != 0;
    request.services = &renderer->host_;
    Result<std::unique_ptr<Device>> device = Device::create(request);
    if (!device) {
        return device.error();
    }
    renderer->device_ = std::move(device).value();
    Result<sluice::Agreement> agreement = agree(*renderer->device_, renderer->host_, info);
    if (!agreement) {
        return agreement.error();
    }
    SluiceRendererInfo& out = renderer->info_;
    out.struct_size = sizeof(out);
    out.timeline = agreement.value().timeline;
    for (std::size_t role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
        out.formats[role] = agreement.value().formats[role];
    }
    out.host_depth_encoding = agreement.value().host_depth_encoding;
    out.image_sets = info.image_sets;
    out.capabilities = renderer->device_->capabilities;
    renderer->outputs_ = info.outputs;

    Result<std::unique_ptr<RendererTimeline>> timeline =
        RendererTimeline::create(*renderer->device_, agreement.value().timeline);
    if (!timeline) {
        return timeline.error();
    }
    renderer->timeline_ = std::move(timeline).value();
    Result<FluidRecorder> recorder = FluidRecorder::create(*renderer->device_);
    if (!recorder) {
        return recorder.error();
    }
    renderer->recorder_.emplace(std::move(recorder).value());
    Result<std::unique_ptr<FrameRing>> frames =
        FrameRing::create(*renderer->device_, *renderer->timeline_, Tracer(renderer->host_), info.image_sets);
    if (!frames) {
        return frames.error();
    }
    renderer->frames_ = std::move(frames).value();
    if (Status status = renderer->createImages(info.width, info.height); !status) {
        return status.error();
    }
    renderer->device_->log(
        SLUICE_LOG_INFO,
        fmt::format("renderer on '{}', {} timeline, {} image sets of {}x{}", renderer->device_->properties.deviceName,
                    sluice::toString(agreement.value().timeline), info.image_sets, info.width, info.height));
    return renderer;
}

Status SluiceRenderer::createImages(std::uint32_t width, std::uint32_t height) {
    SharedImagesDesc desc;
    for (std::size_t role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
        desc.formats[role] = static_cast<SluiceFormat>(info_.formats[role]);
    }
    desc.host_depth_encoding = static_cast<SluiceDepthEncoding>(info_.host_depth_encoding);
    desc.width = width;
    desc.height = height;
    desc.sets = info_.image_sets;
    Result<std::unique_ptr<SharedImages>> images = SharedImages::create(*device_, host_, desc);
    if (!images) {
        return images.error();
    }
    images_ = std::move(images).value();
    info_.width = width;
    info_.height = height;
    return {};
}

Status SluiceRenderer::quiesce() {
    const Drained drained = timeline_->drain(FrameRing::kPatienceNs);
    if (drained != Drained::Idle) {
        return Error{drained == Drained::Lost ? SLUICE_ERROR_DEVICE_LOST : SLUICE_ERROR_INTERNAL, "renderer",
                     "submitted frames do not end", "destroy the renderer and create it again"};
    }
    frames_->collect();
    return {};
}

Status SluiceRenderer::resize(std::uint32_t width, std::uint32_t height) {
    if (Status status = checkSize(width, height); !status) {
        return status;  // the only failure that leaves the images as they were
    }
    Status idle = quiesce();
    if (images_) {
        images_->retire();
        abandoned_.push_back(std::move(images_));
    }
    if (!idle) {
        return idle;
    }
    abandoned_.clear();
    return createImages(width, height);
}

Status SluiceRenderer::setParticles(const SluiceParticles& particles) {
    const Tracer tracer(host_);
    const std::uint64_t begin = tracer.now();
    Result<std::shared_ptr<ParticleSet>> set = createParticleSet(*device_, particles);
    if (!set) {
        return set.error();
    }
    particles_ = std::move(set).value();
    tracer.emit({SLUICE_TRACE_CPU_COPY, SLUICE_TRACK_RENDERER_CPU, "particle upload", begin, tracer.now() - begin,
                 attempted_ + 1, 0, particles_->upload_bytes, SLUICE_HOST_TO_RENDERER});
    return {};
}

Status SluiceRenderer::setEnvironment(const SluiceEnvironment* environment) {
    if (Status status = frames_->waitForAll(); !status) {
        return status;
    }
    if (Status status = recorder_->setEnvironment(environment); !status) {
        return status;
    }
    has_environment_ = environment != nullptr;
    return {};
}

Status SluiceRenderer::setSimulation(const LiveSetup* setup) {
    if (Status status = frames_->waitForAll(); !status) {
        if (simulation_) {
            simulation_->stop();  // there is none from now on; those frames wait for it no more
            ended_ = std::move(simulation_);
        }
        return status;
    }
    if (simulation_ || ended_) {
        (void)
            device_->waitIdle();  // as ~LiveSimulation does for its own queue: the frames' waits hold the semaphore too
    }
    ended_.reset();
    simulation_.reset();
    if (setup == nullptr) {
        return {};
    }
    Result<std::unique_ptr<LiveSimulation>> made = LiveSimulation::create(*device_, *timeline_, Tracer(host_), *setup);
    if (!made) {
        return made.error();
    }
    simulation_ = std::move(made).value();
    return {};
}

Status SluiceRenderer::simulate(std::uint64_t value, double seconds) {
    if (!simulation_) {
        return noSimulation("simulate");
    }
    return simulation_->simulate(value, seconds);
}

Status SluiceRenderer::setBody(const BodyTarget& target) {
    return simulation_ ? simulation_->setBody(target) : Status{noSimulation("set_body")};
}

Status SluiceRenderer::setFlow(const FlowSettings& flow) {
    return simulation_ ? simulation_->setFlow(flow) : Status{noSimulation("set_flow")};
}

Status SluiceRenderer::resetSimulation(LiveStart start) {
    return simulation_ ? simulation_->reset(std::move(start)) : Status{noSimulation("reset_simulation")};
}

Result<FrameFluid> SluiceRenderer::fluidOf(const SluiceFrame& frame) {
    if (frame.simulation == 0) {
        return FrameFluid{particles_, {}};
    }
    if (!simulation_) {
        return noSimulation("frame.simulation");
    }
    const bool captures = (frame.flags & SLUICE_FRAME_CAPTURE_DEPTH) != 0 && simulation_->depthScale() != 0;
    if (Status status = captures ? checkCamera(frame.camera) : Status{}; !status) {
        return status.error();
    }
    Result<SimulatedFluid> fluid =
        simulation_->fluid(frame.simulation, (frame.flags & SLUICE_FRAME_SKIP_SIMULATION_WAIT) != 0);
    if (!fluid) {
        return fluid.error();
    }
    if (captures) {
        auto room = simulation_->captureRoom(*device_, frame.simulation,
                                             captureBytes(info_.width, info_.height, simulation_->depthScale()));
        if (!room) {
            return room.error();
        }
        fluid.value().captured = std::move(room).value();
    }
    return FrameFluid{nullptr, fluid.value()};
}

Status SluiceRenderer::submitFrame(const SluiceFrame& frame) {
    FrameExpectation expected;
    expected.submitted = submitted_;
    expected.attempted = attempted_;
    expected.image_sets = info_.image_sets;
    expected.outputs = outputs_;
    if (Status status = checkFrameOrder(frame, expected); !status) {
        return status;
    }
    attempted_ = frame.frame;
    if (Status status = checkFrameValues(frame, expected); !status) {
        return status;
    }
    if (!images_) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "submit_frame", "there are no images since resize failed",
                     "resize first"};
    }
    if (Status status = frames_->waitForSlot(frame.image_set); !status) {
        return status;
    }
    if (Status status = preparePlan(frame); !status) {
        return status;
    }
    return recordAndSubmit(frame);
}

Status SluiceRenderer::preparePlan(const SluiceFrame& frame) {
    SluiceSceneNeeds needs{};
    needs.struct_size = sizeof(needs);
    needs.width = info_.width;
    needs.height = info_.height;
    needs.particle_count = particles_ ? particles_->count : 0;
    if (frame.simulation != 0 && simulation_) {
        needs.particle_count = simulation_->particles();
    }
    needs.has_environment_map = has_environment_ ? 1 : 0;
    needs.outputs = frame.outputs;
    needs.fluid = frame.fluid;
    if (frame.simulation == 0 || !simulation_ || !simulation_->shaped()) {
        needs.fluid.ellipsoids = 0;  // these particles have no shapes
    }
    if (frame.simulation == 0 || !simulation_ || !simulation_->foams()) {
        needs.fluid.foam = std::min(needs.fluid.foam, 0.0F);  // nor foam; NaN is refused as ever
    }
    const bool mixed = frame.simulation != 0 ? simulation_ && simulation_->mixed() : particles_ && particles_->fluid;
    needs.other_look_count = mixed ? looksApart(frame) : 0;
    Result<Plan> plan = makePlan(needs);
    if (!plan) {
        return plan.error();
    }
    if (plan_ && *plan_ == plan.value()) {
        return {};
    }
    if (Status status = frames_->waitForAll(); !status) {
        return status;
    }
    plan_.reset();
    if (Status status = recorder_->prepare(plan.value()); !status) {
        return status;
    }
    plan_ = std::move(plan).value();
    return {};
}

Status SluiceRenderer::recordAndSubmit(const SluiceFrame& frame) {
    const FrameTargets targets = images_->targets(frame.image_set);
    const Result<FrameFluid> fluid = fluidOf(frame);
    if (!fluid) {
        return fluid.error();
    }
    const std::shared_ptr<const DepthBuffer>& captured = fluid.value().simulated.captured.buffer;
    DepthCapture capture;
    if (captured != nullptr) {
        capture = {captured->memory.buffer(), simulation_->depthScale(), simulation_->depthThickness()};
    }
    const PassRecorder record = [&](VkCommandBuffer commands, const ParticleBuffers& particles, PassTimer& timer) {
        return recorder_->record(commands, frame, *plan_, targets, particles, timer, capture);
    };
    if (Status status = frames_->submit(frame, *images_, fluid.value(), record); !status) {
        return status;
    }
    submitted_ = frame.frame;
    if (frame.simulation != 0) {
        simulation_->drawn(frame.simulation, frame.signal_value, captured);
    }
    if (info_.timeline == SLUICE_TIMELINE_FINISH) {
        return frames_->waitForAll();
    }
    return {};
}

SluiceResult SluiceRenderer::poll(std::uint64_t frame, SluiceFrameStats& stats) {
    SluiceFrameStats found{};
    const SluiceResult result = frames_->poll(frame, found);
    if (result != SLUICE_OK) {
        return result;
    }
    found.struct_size = sizeof(found);
    found.validation_messages = device_->validationMessages();
    stats = found;
    return SLUICE_OK;
}

void SluiceRenderer::destroy(std::unique_ptr<SluiceRenderer> renderer) {
    if (!renderer || !renderer->timeline_) {
        return;
    }
    if (renderer->simulation_) {
        renderer->simulation_->stop();  // or frames might wait for it for ever
    }
    if (renderer->timeline_->drain(kGraceNs) != Drained::Stuck) {
        renderer->frames_->collect();
        return;
    }
    renderer->device_->log(SLUICE_LOG_ERROR, "renderer: submitted frames never end; its device is left behind");
    if (renderer->simulation_) {
        renderer->simulation_->end(kStepNs);
    }
    if (renderer->ended_) {
        renderer->ended_->end(kStepNs);
    }
    renderer->device_->messages->services = nullptr;  // the host may go
    (void)renderer.release();
}
