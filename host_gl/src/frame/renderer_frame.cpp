// SPDX-License-Identifier: MIT
// The frames of a RendererLife: capture, hand over, composite.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>
#include <vector>

#include "compositor/capture.hpp"
#include "compositor/draw_guard.hpp"
#include "frame/renderer_life.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/format.hpp"
#include "timeline/timeline_events.hpp"

namespace sluice::host {

namespace {

/// The screen reads and writes 4 bytes of colour and 4 of depth and stencil a pixel.
constexpr std::uint64_t kScreenBytes = 8;

std::uint64_t texelBytes(std::uint32_t format) {
    const FormatInfo* info = findFormat(format);
    return info != nullptr ? info->bytes_per_texel : 0;
}

}  // namespace

Status RendererLife::checkScreen(const Screen& screen, const char* call) const {
    if (!usable_) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, call, "the renderer has no images since the last resize failed",
                     "resize again, or destroy the FluidHost"};
    }
    if (lost_) {
        return Error{SLUICE_ERROR_DEVICE_LOST, call, "the renderer has lost its device",
                     "destroy the FluidHost and create it again"};
    }
    if (screen.width() != link_.info.width || screen.height() != link_.info.height) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, call,
                     fmt::format("expected a screen of {}x{}, found {}x{}", link_.info.width, link_.info.height,
                                 screen.width(), screen.height()),
                     "call FluidHost::resize when the screen's size changes"};
    }
    return checkDrawable();
}

Status RendererLife::submit(const Screen& screen, const FrameInput& input) {
    composable_ = false;
    if (Status status = checkScreen(screen, "submit"); !status) {
        return status;
    }
    timer_.collect();
    const std::uint64_t frame = next_;
    if (Status status = strike(handOver(screen, input)); !status) {
        return status;
    }
    if (Status status = callRenderer(input, frame); !status) {
        noteLoss(status.error());
        link_.sets->abandoned(frame);
        if (feed() != nullptr) {
            feed()->takenBack(frame);
        }
        // What the caller has asked for wrongly is no sign of a broken renderer.
        return status.error().code == SLUICE_ERROR_INVALID_ARGUMENT ? status : strike(std::move(status));
    }
    if (Status status = strike(link_.sets->promised(frame)); !status) {
        return status;
    }
    submitted_ = frame;
    composable_ = true;
    return {};
}

Status RendererLife::handOver(const Screen& screen, const FrameInput& input) {
    const std::uint64_t frame = next_;
    const std::vector<std::uint32_t> textures =
        link_.services.images().textures(imageSetOf(frame, link_.info.image_sets));
    if (const std::uint64_t owed = link_.sets->owedBefore(frame); owed != 0) {
        if (Status status = waitFor(owed, textures); !status) {
            return status;
        }
        link_.sets->reached(owed);
    }
    if (Status status = link_.sets->beginCapture(frame); !status) {
        return status;
    }
    if (feed() != nullptr) {
        feed()->captureBegins(frame, input.draw_began_ns);
    }
    capture(screen, input.camera, frame);
    if (feed() != nullptr) {
        feed()->captureEnds(frame);
    }
    if (Status status = link_.timeline->signal(gbufferWritten(frame), textures); !status) {
        link_.sets->cancelCapture(frame);
        if (feed() != nullptr) {
            feed()->takenBack(frame);
        }
        return status;
    }
    // From here on the values of this frame are spent, whatever the renderer says.
    next_ = frame + 1;
    return link_.sets->endCapture(frame);
}

void RendererLife::capture(const Screen& screen, const SluiceCamera& camera, std::uint64_t frame) {
    const ImageTable& images = link_.services.images();
    const std::uint32_t set = imageSetOf(frame, link_.info.image_sets);
    const std::uint32_t colour = images.texture(SLUICE_IMAGE_HOST_COLOUR, set);
    const std::uint32_t depth = images.texture(SLUICE_IMAGE_HOST_DEPTH, set);
    const std::uint64_t bytes = std::uint64_t{link_.info.width} * link_.info.height *
                                (kScreenBytes + texelBytes(link_.info.formats[SLUICE_IMAGE_HOST_COLOUR]) +
                                 texelBytes(link_.info.formats[SLUICE_IMAGE_HOST_DEPTH]));
    timer_.begin("capture", frame, bytes);
    captureScreen(screen.framebuffer(), link_.info.width, link_.info.height, colour, link_.linear ? 0 : depth);
    if (link_.linear) {
        std::array<float, 16> projection{};
        std::copy_n(camera.projection, projection.size(), projection.begin());
        link_.linear->run(screen.framebuffer(), depth, projection);
    }
    timer_.end();
}

Status RendererLife::waitFor(std::uint64_t value, const std::vector<std::uint32_t>& textures) {
    const auto scope = watch_.during("timeline_wait", value, link_.config.wait_timeout_ns);
    return link_.timeline->wait(value, link_.config.wait_timeout_ns, textures);
}

Status RendererLife::callRenderer(const FrameInput& input, std::uint64_t frame) {
    auto call = sized<SluiceFrame>();
    call.image_set = imageSetOf(frame, link_.info.image_sets);
    call.frame = frame;
    call.wait_value = gbufferWritten(frame);
    call.signal_value = fluidWritten(frame);
    call.outputs = input.outputs;
    call.flags = input.flags;
    call.camera = input.camera;
    call.sky = input.sky;
    call.fluid = input.fluid;
    call.other_look_count = static_cast<std::uint32_t>(input.other_looks.size());  // the renderer checks it
    std::copy_n(input.other_looks.begin(), std::min<std::size_t>(input.other_looks.size(), std::size(call.other_looks)),
                std::begin(call.other_looks));
    call.simulation = input.simulation;
    const std::optional<FaultPlan>& fault = link_.config.fault;
    if (fault && fault->kind == FaultKind::SkipWait && fault->direction == SLUICE_HOST_TO_RENDERER &&
        fault->frame == frame) {
        call.flags |= SLUICE_FRAME_SKIP_WAIT;
    }
    if (fault && fault->direction == SLUICE_SIMULATION_TO_RENDERER && fault->frame == frame) {
        call.flags |= SLUICE_FRAME_SKIP_SIMULATION_WAIT;
    }
    tellSubmit(frame);
    const std::uint64_t begin = traceClock(link_.config.trace);
    const auto scope = watch_.during("submit_frame", frame);
    Status status = faults_.submit(link_.renderer, call);
    traceStep(link_.config.trace, SLUICE_TRACE_SUBMIT, SLUICE_TRACK_HOST_CPU, SLUICE_RENDERER_TO_HOST,
              fluidWritten(frame), begin, "submit_frame");
    return status;
}

void RendererLife::tellSubmit(std::uint64_t frame) {
    if (feed() != nullptr && !feed()->submits(frame)) {
        link_.services.log(SLUICE_LOG_WARNING,
                           "ledger: off from here on: the renderer sends no trace events of its queue");
    }
}

Status RendererLife::composite(const Screen& screen) {
    if (Status status = checkScreen(screen, "composite"); !status) {
        return status;
    }
    if (!composable_) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "composite", "no submitted frame waits for its composite",
                     "call it once after each submit that succeeded"};
    }
    composable_ = false;
    const std::uint64_t frame = submitted_;
    const std::vector<std::uint32_t> textures =
        link_.services.images().textures(imageSetOf(frame, link_.info.image_sets));
    if (Status status = strike(waitFor(fluidWritten(frame), textures)); !status) {
        return status;
    }
    link_.sets->reached(fluidWritten(frame));
    if (Status status = strike(link_.sets->beginComposite(frame)); !status) {
        return status;
    }
    draw(screen, frame);
    // No texture is named: the set stays with GL until the next odd value gives it away (docs/protocol.md). The picture
    // is drawn, and that value implies this one, so a failure here is news but not a failed composite.
    if (const Status status = link_.timeline->signal(compositeRead(frame), {}); !status) {
        link_.services.log(SLUICE_LOG_WARNING, status.error().message());
    }
    strikes_ = 0;
    return link_.sets->endComposite(frame);
}

void RendererLife::draw(const Screen& screen, std::uint64_t frame) {
    const ImageTable& images = link_.services.images();
    const std::uint32_t set = imageSetOf(frame, link_.info.image_sets);
    const std::uint64_t bytes = std::uint64_t{link_.info.width} * link_.info.height *
                                (2 * kScreenBytes + texelBytes(link_.info.formats[SLUICE_IMAGE_FLUID_COLOUR]) +
                                 texelBytes(link_.info.formats[SLUICE_IMAGE_FLUID_DEPTH]));
    if (feed() != nullptr) {
        feed()->compositeReads(frame);
    }
    timer_.begin("composite", frame, bytes);
    compositor_.draw(screen.framebuffer(), link_.info.width, link_.info.height,
                     images.texture(SLUICE_IMAGE_FLUID_COLOUR, set), images.texture(SLUICE_IMAGE_FLUID_DEPTH, set));
    timer_.end();
}

}  // namespace sluice::host
