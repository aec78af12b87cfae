// SPDX-License-Identifier: MIT
// A Session's frame: its camera, its begin and its end.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>

#include "api/session.hpp"
#include "share/gl_errors.hpp"

namespace sluice::host {

namespace {

/// More than this the fluid does not make good after a pause: it would take the time of many frames.
constexpr double kLongestStride = 0.1;

std::optional<Matrix> kept(const float* matrix) {
    if (matrix == nullptr) {
        return std::nullopt;
    }
    Matrix copy{};
    std::copy_n(matrix, copy.size(), copy.begin());
    return copy;
}

Error notBegun() {
    return {SLUICE_NOT_READY, "sluice_end_frame", "the fluid was set or switched on within the frame", ""};
}

}  // namespace

Status Session::setCamera(const float* view, const float* projection) {
    view_ = kept(view);
    projection_ = kept(projection);
    if (view_ && projection_) {
        return {};
    }
    view_.reset();
    projection_.reset();
    if (view != nullptr || projection != nullptr) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "camera", "one of its matrices is NULL and the other is not",
                     "give both, or neither"};
    }
    if (currentContext().kind == ContextKind::None) {
        return noContext("camera");
    }
    const GlErrorScope errors;
    const Result<std::array<Matrix, 2>> found = matricesOfContext();
    if (!found) {
        return found.error();
    }
    view_ = found.value()[0];
    projection_ = found.value()[1];
    return {};
}

Status Session::beginFrame(const float* view, const float* projection, double time) {
    in_frame_ = true;
    begun_in_ = currentContext();
    begin_error_.reset();
    const double passed = clock_ && std::isfinite(time) ? time - *clock_ : 0.0;
    if (std::isfinite(time)) {
        clock_ = time;
    }
    began_active_ = active();
    if (!began_active_) {
        return {};
    }
    owed_ = std::clamp(owed_ + std::max(passed, 0.0), 0.0, kLongestStride);
    Status camera = setCamera(view, projection);
    if (Status status = flowOn(); !status) {
        begin_error_ = status.error();
        return status;
    }
    return camera;
}

Status Session::flowOn() {
    if (begun_in_.kind == ContextKind::None) {
        return noContext("sluice_begin_frame");
    }
    const GlErrorScope errors;
    range_at_begin_ = depthRange();
    if (Status status = settle(std::nullopt); !status) {
        return status;
    }
    // What has not been drawn yet is not left behind: an engine that skips frames must not pile up steps.
    if (!pending_) {
        Status status = host_->simulate(value_ + 1, value_ == 0 ? 0.0 : owed_);
        if (!status && !host_->recovering()) {
            return status;
        }
        // The number is spent even where a renderer was lost over it: the next one begins with it, in this very frame
        // perhaps. The log has that; whether the frame gets fluid sluice_end_frame says.
        ++value_;
        owed_ = 0.0;
        pending_ = true;
    }
    return {};
}

Status Session::endFrame() {
    if (!in_frame_) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "sluice_end_frame", "no frame has begun",
                     "call sluice_begin_frame before it, once for each"};
    }
    in_frame_ = false;
    if (!active()) {
        return {};
    }
    const auto begin = std::chrono::steady_clock::now();
    Status status = draw();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    end_frame_seconds_ = took.count();
    if (trace_ != nullptr) {
        for (const TraceRecord& event : trace_->drain()) {
            addTo(timings_, event);
        }
    }
    ++(status ? frames_ : frames_without_);
    return status;
}

Result<SluiceCamera> Session::depthCamera() {
    // Begin and end stand around the world: a range that both have seen is the world's. One that only the end has may
    // be what a weapon before the eye was drawn with.
    DepthMapping depth{clipsZeroToOne(), depthRange()};
    constexpr std::array kWhole{0.0F, 1.0F};
    if (depth.range != kWhole && depth.range != range_at_begin_) {
        if (!range_told_) {
            range_told_ = true;
            log_(SLUICE_LOG_WARNING,
                 fmt::format("camera: glDepthRange is {} to {} at sluice_end_frame and was {} to {} at "
                             "sluice_begin_frame: the world is taken to be drawn with 0 to 1 (set the world's range "
                             "before sluice_begin_frame and leave it until sluice_end_frame)",
                             depth.range[0], depth.range[1], range_at_begin_[0], range_at_begin_[1]));
        }
        depth.range = kWhole;
    }
    Result<SluiceCamera> camera = cameraOf(*view_, *projection_, depth);
    if (camera) {
        if (Status status = checkDepthTest(); !status) {
            return status.error();
        }
    }
    return camera;
}

Result<Extent> Session::extentOf(const Target& target, const CurrentContext& present) const {
    const std::optional<Extent> real = target.extent ? target.extent : drawableExtent(present);
    if (follows_drawable_) {
        if (!real) {
            return Error{SLUICE_ERROR_UNSUPPORTED, "size of the drawable", "the window system does not tell it",
                         "give it with sluice_resize"};
        }
        return *real;
    }
    if (!real || *real == extent_) {
        return extent_;
    }
    // A smaller one is right for an engine that draws into a part of it, and wrong for one that fills the whole.
    std::array<GLint, 4> viewport{};
    glGetIntegerv(GL_VIEWPORT, viewport.data());
    const bool filled =
        viewport == std::array<GLint, 4>{0, 0, static_cast<GLint>((*real)[0]), static_cast<GLint>((*real)[1])};
    if ((*real)[0] < extent_[0] || (*real)[1] < extent_[1] || filled) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT,
                     target.extent ? "framebuffer bound for drawing" : "window bound for drawing",
                     fmt::format("it is {}x{}, Sluice was told {}x{}", (*real)[0], (*real)[1], extent_[0], extent_[1]),
                     "call sluice_resize with its size, or give 0 and 0 in SluiceOptions to have it asked"};
    }
    return extent_;
}

Status Session::draw() {
    if (!began_active_) {
        return notBegun();
    }
    const CurrentContext present = currentContext();
    // A frame that could not begin ends with the reason that it had.
    if (begin_error_ && present == begun_in_) {
        return *begin_error_;
    }
    if (!view_ || !projection_) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "sluice_end_frame", "there is no camera",
                     "give matrices to sluice_begin_frame or sluice_set_camera"};
    }
    if (Status status = notThere(); !status) {
        return status;
    }
    if (present.kind == ContextKind::None || !(present == context_) || host_ == nullptr) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "sluice_end_frame",
                     "the context is not the one that sluice_begin_frame was called in", "call both in the same"};
    }
    const GlErrorScope errors;
    const Result<SluiceCamera> camera = depthCamera();
    if (!camera) {
        return camera.error();
    }
    const Result<Target> bound = boundTarget();
    if (!bound) {
        return bound.error();
    }
    const Target& target = bound.value();
    const Result<Extent> size = extentOf(target, present);
    if (!size) {
        return size.error();
    }
    const Extent extent = size.value();
    const std::uint32_t contexts = contexts_;
    if (Status status = settle(extent); !status) {
        return status;
    }
    if (value_ == 0 && contexts_ == contexts) {
        return notBegun();
    }
    if (value_ == 0) {
        return Error{SLUICE_ERROR_DEVICE_LOST, "sluice_end_frame", "the context was lost within the frame", ""};
    }
    const Screen screen = Screen::borrowed(target.framebuffer, extent[0], extent[1]);
    Screen source = Screen::borrowed(target.framebuffer, extent[0], extent[1]);
    if (target.framebuffer != 0 && target.samples > 0) {
        if (Status status = resolve_.take(target, extent); !status) {
            return status;
        }
        source = Screen::borrowed(resolve_.framebuffer(), extent[0], extent[1]);
    }
    FrameInput input;
    input.camera = camera.value();
    input.sky = sky_;
    input.fluid = look_;
    input.other_looks = other_looks_;
    input.simulation = value_;
    input.flags = meets_depth_ ? SLUICE_FRAME_CAPTURE_DEPTH : 0;
    if (Status status = host_->submit(source, input); !status) {
        // Without a renderer nothing flows; the number is spent all the same.
        pending_ = false;
        return status;
    }
    pending_ = false;
    const auto begin = std::chrono::steady_clock::now();
    Status status = host_->composite(screen);
    wait_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    drawn_ = status ? host_->frame() : drawn_;
    return status;
}

}  // namespace sluice::host
