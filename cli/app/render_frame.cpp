// SPDX-License-Identifier: MIT
// One frame of a render: the engine's, with fluid in it, and what is read back of it.
#include <chrono>

#include "app/live_bodies.hpp"
#include "app/log.hpp"
#include "app/looks.hpp"
#include "app/render_session.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::cli {
namespace {

/// Milliseconds that `work` took.
template <typename Work>
double timed(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    return elapsed.count();
}

/// The engine draws the bodies where they are at the value that the frame draws, so it waits for that. So it does for
/// the first frame, before which there may be many values. In the frame that brings a new renderer they stand where
/// they stood.
Status awaitSimulation(RenderSession& session, const LiveFluid& fluid, std::int64_t frame,
                       const RenderOptions& options) {
    const auto value = static_cast<std::uint64_t>(frame);
    if (Status status = awaitValue(*session.fluid, value, nanoseconds(options.deadline_s)); !status) {
        return status;
    }
    if (fluid.bodies.empty()) {
        return {};
    }
    const Result<SluiceBodies> bodies = session.fluid->simulationBodies(value);
    if (!bodies) {
        return bodies.error();
    }
    session.bodies = drawnBodies(fluid, bodies.value());
    return {};
}

/// Reads the images of the set that the last frame used.
void readFluid(FrameLayers& layers, const RenderSession& session, const RenderInputs& inputs) {
    const auto read = [&](SluiceImageRole role) -> std::optional<host::Pixels> {
        const std::uint32_t texture = session.fluid->texture(role);
        if (texture == 0) {
            return std::nullopt;
        }
        const auto format = static_cast<SluiceFormat>(session.fluid->info().formats[role]);
        return host::readTexture(texture, format, inputs.size.width, inputs.size.height, session.trace.get());
    };
    layers.fluid_colour = read(SLUICE_IMAGE_FLUID_COLOUR);
    layers.fluid_depth = read(SLUICE_IMAGE_FLUID_DEPTH);
    layers.fluid_normal = read(SLUICE_IMAGE_FLUID_NORMAL);
    layers.fluid_thickness = read(SLUICE_IMAGE_FLUID_THICKNESS);
}

}  // namespace

FrameResult renderFrame(RenderSession& session, const RenderInputs& inputs, const RenderOptions& options,
                        std::int64_t frame) {
    FrameResult result;
    const bool layers = !options.layers.empty();
    const SluiceCamera camera = scene::cameraAt(inputs.scene, frame, inputs.size);
    const std::uint64_t logic_began = monotonicNanoseconds();
    result.logic_ms = timed([&] {
        // From frame 1 on, whichever is drawn first, so that every range of frames shows the same.
        for (; session.animated < frame; ++session.animated) {
            session.engine.animate(1.0F / inputs.scene.simulation.frames_per_second);
        }
    });
    if (!inputs.scene.engine.banners.empty()) {
        auto thought = sized<SluiceTraceEvent>();
        thought.kind = SLUICE_TRACE_MARK;
        thought.track = SLUICE_TRACK_HOST_CPU;
        thought.begin_ns = logic_began;
        thought.duration_ns = monotonicNanoseconds() - logic_began;
        thought.frame = static_cast<std::uint64_t>(frame);
        thought.name = "host animation";
        session.trace->record(thought);
    }
    if (session.fluid && inputs.live && (!session.bodies.empty() || session.fluid->frame() == 0)) {
        if (Status status = awaitSimulation(session, *inputs.live, frame, options); !status) {
            result.failure = status.error();
        }
    }
    const std::uint64_t draw_began = monotonicNanoseconds();
    result.draw_ms = timed([&] {
        session.screen.bind();
        session.engine.draw(camera, inputs.scene.sky, inputs.live ? session.bodies : inputs.bodies);
    });
    if (layers) {
        result.layers.host_colour = host::readColour(session.screen, session.trace.get());
        result.layers.host_depth = host::readDepth(session.screen, session.trace.get());
    }
    if (session.fluid) {
        host::FrameInput input;
        input.camera = camera;
        input.sky = inputs.scene.sky;
        const std::vector<SluiceLook> others = otherLooks(inputs.scene);
        input.fluid = firstLook(inputs.scene);
        input.other_looks = others;
        input.outputs = layerOutputs(options);
        input.draw_began_ns = draw_began;
        input.simulation = inputs.live ? static_cast<std::uint64_t>(frame) : 0;
        if (inputs.live && inputs.live->settings.depth_scale != 0) {
            input.flags |= SLUICE_FRAME_CAPTURE_DEPTH;
        }
        Status status;
        result.submit_ms = timed([&] { status = session.fluid->submit(session.screen, input); });
        if (status) {
            result.composite_ms = timed([&] { status = session.fluid->composite(session.screen); });
        }
        result.with_fluid = status.ok();
        if (!status) {
            result.failure = status.error();
        }
    }
    if (result.with_fluid) {
        if (Result<SluiceFrameStats> stats = session.fluid->stats(session.fluid->frame()); stats) {
            result.stats = stats.value();
        } else {
            log(SLUICE_LOG_WARNING, "statistics: " + stats.error().message());
        }
        if (layers) {
            readFluid(result.layers, session, inputs);
        }
    }
    result.layers.beauty = host::readColour(session.screen, session.trace.get());
    return result;
}

}  // namespace sluice::cli
