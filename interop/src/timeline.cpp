// SPDX-License-Identifier: MIT
#include "sluice/timeline.hpp"

#include <fmt/format.h>

#include <array>
#include <cassert>

namespace sluice {

namespace {

constexpr std::array<std::string_view, 6> kStepNames{"idle at the host",          "being captured",
                                                     "in flight to the renderer", "at the renderer",
                                                     "in flight to the host",     "being composited"};

}  // namespace

HandOff::HandOff(std::uint32_t image_set, std::uint32_t image_sets) : set_(image_set), sets_(image_sets) {
    assert(image_sets > 0 && image_set < image_sets);
}

Error HandOff::broken(std::uint64_t frame, std::string_view call, std::string detail) const {
    return {SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("hand-off of image set {}, {} of frame {}", set_, call, frame),
            std::move(detail), "follow the table of states in docs/protocol.md"};
}

Status HandOff::expect(std::uint64_t frame, Step step, std::string_view call) const {
    if (step_ != step) {
        return broken(frame, call,
                      fmt::format("expected the set {}, found it {}", kStepNames[static_cast<std::size_t>(step)],
                                  kStepNames[static_cast<std::size_t>(step_)]));
    }
    if (frame != frame_) {
        return broken(frame, call, fmt::format("the set belongs to frame {}", frame_));
    }
    return {};
}

Status HandOff::hostAcquire(std::uint64_t frame, std::uint64_t renderer_value) {
    constexpr std::string_view kCall = "host acquire";
    if (frame == 0 || imageSetOf(frame, sets_) != set_) {
        return broken(frame, kCall, fmt::format("frames from 1 use set (frame - 1) mod {}", sets_));
    }
    if (frame <= frame_) {
        return broken(frame, kCall, fmt::format("frames only increase, and frame {} has used the set", frame_));
    }
    if (step_ != Step::Idle && step_ != Step::InFlightToHost) {
        return broken(frame, kCall,
                      fmt::format("the set is {} for frame {}", kStepNames[static_cast<std::size_t>(step_)], frame_));
    }
    if (renderer_value < owed_renderer_) {
        return broken(
            frame, kCall,
            fmt::format("the renderer's counter must have reached {}, found {}", owed_renderer_, renderer_value));
    }
    frame_ = frame;
    owed_renderer_ = 0;
    step_ = Step::Capture;
    return {};
}

Status HandOff::hostRelease(std::uint64_t frame) {
    if (Status status = expect(frame, Step::Capture, "host release"); !status) {
        return status;
    }
    step_ = Step::InFlightToRenderer;
    return {};
}

Status HandOff::rendererAcquire(std::uint64_t frame, std::uint64_t host_value) {
    constexpr std::string_view kCall = "renderer acquire";
    if (Status status = expect(frame, Step::InFlightToRenderer, kCall); !status) {
        return status;
    }
    if (host_value < gbufferWritten(frame)) {
        return broken(
            frame, kCall,
            fmt::format("the host's counter must have reached {}, found {}", gbufferWritten(frame), host_value));
    }
    step_ = Step::Renderer;
    return {};
}

Status HandOff::rendererRelease(std::uint64_t frame) {
    if (Status status = expect(frame, Step::Renderer, "renderer release"); !status) {
        return status;
    }
    owed_renderer_ = fluidWritten(frame);
    step_ = Step::InFlightToHost;
    return {};
}

Status HandOff::hostCompositeBegin(std::uint64_t frame, std::uint64_t renderer_value) {
    constexpr std::string_view kCall = "composite begin";
    if (Status status = expect(frame, Step::InFlightToHost, kCall); !status) {
        return status;
    }
    if (renderer_value < fluidWritten(frame)) {
        return broken(
            frame, kCall,
            fmt::format("the renderer's counter must have reached {}, found {}", fluidWritten(frame), renderer_value));
    }
    step_ = Step::Composite;
    return {};
}

Status HandOff::hostCompositeEnd(std::uint64_t frame) {
    if (Status status = expect(frame, Step::Composite, "composite end"); !status) {
        return status;
    }
    step_ = Step::Idle;
    return {};
}

void HandOff::abandon(std::uint64_t frame) {
    const bool present = frame == frame_;
    const bool skipped = frame > frame_ && imageSetOf(frame, sets_) == set_ && step_ == Step::Idle;
    if (frame == 0 || !(present || skipped)) {
        return;
    }
    // A promised value (owed_renderer_) stays owed: the queue may still be writing the set when the host gives up on
    // it. Before the promise nothing was submitted, and the value may never come.
    frame_ = frame;
    step_ = Step::Idle;
}

Holder HandOff::holder() const {
    switch (step_) {
        case Step::InFlightToRenderer:
            return Holder::InFlightToRenderer;
        case Step::Renderer:
            return Holder::Renderer;
        case Step::InFlightToHost:
            return Holder::InFlightToHost;
        case Step::Idle:
        case Step::Capture:
        case Step::Composite:
            break;
    }
    return Holder::Host;
}

}  // namespace sluice
