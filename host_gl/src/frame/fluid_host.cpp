// SPDX-License-Identifier: MIT
#include "sluice/host_gl/fluid_host.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "compositor/capture.hpp"
#include "compositor/composite.hpp"
#include "compositor/draw_guard.hpp"
#include "compositor/gpu_timer.hpp"
#include "compositor/linear_depth.hpp"
#include "frame/check_info.hpp"
#include "frame/host_services.hpp"
#include "frame/image_sets.hpp"
#include "frame/renderer.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/format.hpp"
#include "sluice/host_gl/context.hpp"
#include "timeline/fallback.hpp"
#include "timeline/host_timeline.hpp"
#include "timeline/timeline_events.hpp"

namespace sluice::host {

namespace {

/// The screen reads and writes 4 bytes of colour and 4 of depth and stencil a pixel.
constexpr std::uint64_t kScreenBytes = 8;

std::uint64_t texelBytes(std::uint32_t format) {
    const FormatInfo* info = findFormat(format);
    return info != nullptr ? info->bytes_per_texel : 0;
}

SluiceCreateInfo createInfo(const FluidHostConfig& config, SluiceTimelineKind timeline) {
    SluiceCreateInfo info = sized<SluiceCreateInfo>();
    info.width = config.width;
    info.height = config.height;
    info.image_sets = config.image_sets;
    info.timeline = timeline;
    info.validation = config.validation ? 1 : 0;
    info.outputs = config.outputs;
    info.host_depth_format = config.host_depth;
    info.host = queryCapabilities();
    return info;
}

class FluidHostImpl final : public FluidHost {
  public:
    explicit FluidHostImpl(const FluidHostConfig& config)
        : config_(config), services_(config.log, config.trace), timer_(config.trace) {}
    FluidHostImpl(const FluidHostImpl&) = delete;
    FluidHostImpl& operator=(const FluidHostImpl&) = delete;
    ~FluidHostImpl() override {
        // GL's own signals must have landed before the renderer is asked to end: its queue may wait for them, and it
        // cannot know whether they are late or lost. The last frame's passes have ended then, too.
        finishGl();
        close();
    }

    [[nodiscard]] Status start(const PluginLibrary& library);

    [[nodiscard]] const SluiceRendererInfo& info() const override { return info_; }
    [[nodiscard]] Status resize(std::uint32_t width, std::uint32_t height) override;
    [[nodiscard]] Status setParticles(const SluiceParticles& particles) override {
        return renderer_.setParticles(particles);
    }
    [[nodiscard]] Status setEnvironment(const SluiceEnvironment* environment) override {
        return renderer_.setEnvironment(environment);
    }
    [[nodiscard]] Status submit(const Screen& screen, const FrameInput& input) override;
    [[nodiscard]] Status composite(const Screen& screen) override;
    [[nodiscard]] std::uint64_t frame() const override { return submitted_; }
    [[nodiscard]] Result<SluiceFrameStats> stats(std::uint64_t frame) override {
        Result<SluiceFrameStats> stats = renderer_.stats(frame, config_.wait_timeout_ns);
        noteLoss(stats ? 0 : stats.error().code);
        timer_.collect();
        return stats;
    }
    [[nodiscard]] std::uint32_t texture(SluiceImageRole role) const override {
        return services_.images().texture(role, submitted_ == 0 ? 0 : imageSetOf(submitted_, info_.image_sets));
    }

  private:
    /// Renderer, images and timeline. `stage` tells how far it came.
    enum class Stage : std::uint8_t { Renderer, Timeline, Done };
    [[nodiscard]] Status open(const PluginLibrary& library, SluiceTimelineKind timeline, Stage& stage);
    void close();
    /// Remembers that the device is lost: from then on no GL wait is recorded for it (docs/protocol.md).
    void noteLoss(std::int32_t code) { lost_ = lost_ || code == SLUICE_ERROR_DEVICE_LOST; }
    /// Waits until the GL command stream has ended and records its passes.
    void finishGl();
    [[nodiscard]] Status adoptImages();
    [[nodiscard]] Status checkScreen(const Screen& screen, const char* call) const;
    void capture(const Screen& screen, const SluiceCamera& camera, std::uint64_t frame);
    [[nodiscard]] Status callRenderer(const FrameInput& input, std::uint64_t frame);

    FluidHostConfig config_;
    HostServices services_;
    GpuTimer timer_;
    Renderer renderer_;
    SluiceRendererInfo info_{};
    Compositor compositor_;
    std::optional<LinearDepthPass> linear_;
    std::optional<ImageSets> sets_;
    std::unique_ptr<HostTimeline> timeline_;
    std::uint64_t next_ = 1;       ///< number of the next frame
    std::uint64_t submitted_ = 0;  ///< the last frame that the renderer accepted
    bool composable_ = false;      ///< that frame waits for its composite
    bool usable_ = false;          ///< false after a failed resize
    bool lost_ = false;            ///< the renderer has said that its device is lost
};

Status FluidHostImpl::open(const PluginLibrary& library, SluiceTimelineKind timeline, Stage& stage) {
    stage = Stage::Renderer;
    Result<Renderer> renderer = Renderer::create(library.api(), services_.table(), createInfo(config_, timeline));
    if (!renderer) {
        return renderer.error();
    }
    renderer_ = std::move(renderer).value();
    if (Status status = adoptImages(); !status) {
        return status;
    }
    sets_.emplace(info_.image_sets, services_.images(), config_.trace);
    stage = Stage::Timeline;
    TimelineDeps deps;
    deps.api = &renderer_.api();
    deps.renderer = renderer_.handle();
    deps.trace = config_.trace;
    deps.log = [this](SluiceLogLevel level, std::string_view text) { services_.log(level, text); };
    Result<std::unique_ptr<HostTimeline>> made =
        makeHostTimeline(static_cast<SluiceTimelineKind>(info_.timeline), deps);
    if (!made) {
        return made.error();
    }
    timeline_ = std::move(made).value();
    stage = Stage::Done;
    return {};
}

void FluidHostImpl::close() {
    // The bridge may still owe values that the renderer's queue waits for, so it drains before the renderer goes.
    timeline_.reset();
    renderer_ = Renderer{};
    services_.images().clear();
}

Status FluidHostImpl::start(const PluginLibrary& library) {
    if (Status status = checkDrawable(); !status) {
        return status;
    }
    Result<Compositor> compositor = Compositor::create();
    if (!compositor) {
        return compositor.error();
    }
    compositor_ = std::move(compositor).value();
    Stage stage{};
    Status status = open(library, config_.timeline, stage);
    if (stage == Stage::Timeline && config_.timeline == SLUICE_TIMELINE_AUTO) {
        // Extensions that are advertised may still fail between two drivers. Only the next kind's renderer has the
        // semaphores that the next kind needs, so the renderer starts anew as well.
        auto failed = static_cast<SluiceTimelineKind>(info_.timeline);
        for (const SluiceTimelineKind next : timelinesAfter(failed)) {
            services_.log(SLUICE_LOG_WARNING, fmt::format("timeline {} failed at start-up, {} is next: {}",
                                                          toString(failed), toString(next), status.error().message()));
            close();
            failed = next;
            status = open(library, next, stage);
            if (status) {
                break;
            }
        }
    }
    if (!status) {
        return status;
    }
    usable_ = true;
    services_.log(SLUICE_LOG_INFO,
                  fmt::format("renderer {} {}: {} image sets of {}x{}, timeline {}", renderer_.api().name,
                              renderer_.api().version != nullptr ? renderer_.api().version : "", info_.image_sets,
                              info_.width, info_.height, toString(timeline_->kind())));
    return {};
}

Status FluidHostImpl::adoptImages() {
    Result<SluiceRendererInfo> info = renderer_.info();
    if (!info) {
        return info.error();
    }
    info_ = info.value();
    if (Status status = checkInfo(info_, config_, services_.images()); !status) {
        return status;
    }
    linear_.reset();
    if (info_.host_depth_encoding == SLUICE_DEPTH_LINEAR) {
        Result<LinearDepthPass> pass = LinearDepthPass::create(info_.width, info_.height);
        if (!pass) {
            return pass.error();
        }
        linear_.emplace(std::move(pass).value());
    }
    return {};
}

void FluidHostImpl::finishGl() {
    const bool on_gpu = timeline_ != nullptr &&
                        (timeline_->kind() == SLUICE_TIMELINE_NATIVE || timeline_->kind() == SLUICE_TIMELINE_BINARY);
    // A GL wait that was recorded before the device was lost might never end.
    if (!(lost_ && on_gpu)) {
        glFinish();
    }
    timer_.collect();
}

Status FluidHostImpl::resize(std::uint32_t width, std::uint32_t height) {
    if (Status status = checkExtent(width, height); !status) {
        return status;
    }
    // Nothing of the old images may be in use on this side either.
    finishGl();
    usable_ = false;
    composable_ = false;
    Status status = renderer_.resize(width, height);
    if (status) {
        config_.width = width;
        config_.height = height;
        status = adoptImages();
    }
    sets_->reset();
    if (!status) {
        services_.images().clear();
        return status;
    }
    usable_ = true;
    return {};
}

Status FluidHostImpl::checkScreen(const Screen& screen, const char* call) const {
    if (!usable_) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, call, "the renderer has no images since the last resize failed",
                     "resize again, or destroy the FluidHost"};
    }
    if (lost_) {
        return Error{SLUICE_ERROR_DEVICE_LOST, call, "the renderer has lost its device",
                     "destroy the FluidHost and create it again"};
    }
    if (screen.width() != info_.width || screen.height() != info_.height) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, call,
                     fmt::format("expected a screen of {}x{}, found {}x{}", info_.width, info_.height, screen.width(),
                                 screen.height()),
                     "call FluidHost::resize when the screen's size changes"};
    }
    return checkDrawable();
}

void FluidHostImpl::capture(const Screen& screen, const SluiceCamera& camera, std::uint64_t frame) {
    const ImageTable& images = services_.images();
    const std::uint32_t set = imageSetOf(frame, info_.image_sets);
    const std::uint32_t colour = images.texture(SLUICE_IMAGE_HOST_COLOUR, set);
    const std::uint32_t depth = images.texture(SLUICE_IMAGE_HOST_DEPTH, set);
    const std::uint64_t bytes = std::uint64_t{info_.width} * info_.height *
                                (kScreenBytes + texelBytes(info_.formats[SLUICE_IMAGE_HOST_COLOUR]) +
                                 texelBytes(info_.formats[SLUICE_IMAGE_HOST_DEPTH]));
    timer_.begin("capture", frame, bytes);
    captureScreen(screen.framebuffer(), info_.width, info_.height, colour, linear_ ? 0 : depth);
    if (linear_) {
        std::array<float, 16> projection{};
        std::copy_n(camera.projection, projection.size(), projection.begin());
        linear_->run(screen.framebuffer(), depth, projection);
    }
    timer_.end();
}

Status FluidHostImpl::callRenderer(const FrameInput& input, std::uint64_t frame) {
    SluiceFrame call = sized<SluiceFrame>();
    call.image_set = imageSetOf(frame, info_.image_sets);
    call.frame = frame;
    call.wait_value = gbufferWritten(frame);
    call.signal_value = fluidWritten(frame);
    call.outputs = input.outputs;
    call.flags = input.flags;
    call.camera = input.camera;
    call.sky = input.sky;
    call.fluid = input.fluid;
    const std::uint64_t begin = traceClock(config_.trace);
    Status status = renderer_.submit(call);
    traceStep(config_.trace, SLUICE_TRACE_SUBMIT, SLUICE_TRACK_HOST_CPU, SLUICE_RENDERER_TO_HOST, fluidWritten(frame),
              begin, "submit_frame");
    return status;
}

Status FluidHostImpl::submit(const Screen& screen, const FrameInput& input) {
    composable_ = false;
    if (Status status = checkScreen(screen, "submit"); !status) {
        return status;
    }
    timer_.collect();
    const std::uint64_t frame = next_;
    const std::vector<std::uint32_t> textures = services_.images().textures(imageSetOf(frame, info_.image_sets));
    if (const std::uint64_t owed = sets_->owedBefore(frame); owed != 0) {
        if (Status status = timeline_->wait(owed, config_.wait_timeout_ns, textures); !status) {
            noteLoss(status.error().code);
            return status;
        }
        sets_->reached(owed);
    }
    if (Status status = sets_->beginCapture(frame); !status) {
        return status;
    }
    capture(screen, input.camera, frame);
    if (Status status = timeline_->signal(gbufferWritten(frame), textures); !status) {
        sets_->cancelCapture(frame);
        return status;
    }
    // From here on the values of this frame are spent, whatever the renderer says.
    next_ = frame + 1;
    if (Status status = sets_->endCapture(frame); !status) {
        return status;
    }
    if (Status status = callRenderer(input, frame); !status) {
        noteLoss(status.error().code);
        sets_->abandoned(frame);
        return status;
    }
    if (Status status = sets_->promised(frame); !status) {
        return status;
    }
    submitted_ = frame;
    composable_ = true;
    return {};
}

Status FluidHostImpl::composite(const Screen& screen) {
    if (Status status = checkScreen(screen, "composite"); !status) {
        return status;
    }
    if (!composable_) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "composite", "no submitted frame waits for its composite",
                     "call it once after each submit that succeeded"};
    }
    composable_ = false;
    const std::uint64_t frame = submitted_;
    const ImageTable& images = services_.images();
    const std::uint32_t set = imageSetOf(frame, info_.image_sets);
    const std::vector<std::uint32_t> textures = images.textures(set);
    if (Status status = timeline_->wait(fluidWritten(frame), config_.wait_timeout_ns, textures); !status) {
        noteLoss(status.error().code);
        return status;
    }
    sets_->reached(fluidWritten(frame));
    if (Status status = sets_->beginComposite(frame); !status) {
        return status;
    }
    const std::uint64_t bytes = std::uint64_t{info_.width} * info_.height *
                                (2 * kScreenBytes + texelBytes(info_.formats[SLUICE_IMAGE_FLUID_COLOUR]) +
                                 texelBytes(info_.formats[SLUICE_IMAGE_FLUID_DEPTH]));
    timer_.begin("composite", frame, bytes);
    compositor_.draw(screen.framebuffer(), info_.width, info_.height, images.texture(SLUICE_IMAGE_FLUID_COLOUR, set),
                     images.texture(SLUICE_IMAGE_FLUID_DEPTH, set));
    timer_.end();
    // No texture is named: the set stays with GL until the next odd value gives it away (docs/protocol.md). The picture
    // is drawn, and that value implies this one, so a failure here is news but not a failed composite.
    if (const Status status = timeline_->signal(compositeRead(frame), {}); !status) {
        services_.log(SLUICE_LOG_WARNING, status.error().message());
    }
    return sets_->endComposite(frame);
}

}  // namespace

Result<std::unique_ptr<FluidHost>> FluidHost::create(const PluginLibrary& library, const FluidHostConfig& config) {
    if (Status status = checkConfig(config); !status) {
        return status.error();
    }
    auto host = std::make_unique<FluidHostImpl>(config);
    if (Status status = host->start(library); !status) {
        return status.error();
    }
    return std::unique_ptr<FluidHost>(std::move(host));
}

}  // namespace sluice::host
