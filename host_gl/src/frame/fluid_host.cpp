// SPDX-License-Identifier: MIT
#include "sluice/host_gl/fluid_host.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "frame/check_info.hpp"
#include "frame/kept_scene.hpp"
#include "frame/renderer_life.hpp"

namespace sluice::host {

namespace {

// Marks what was thrown; short, as the details are, so that it needs no memory.
constexpr const char* kThrown = "FluidHost";

template <typename Body>
Status withoutThrowing(Body body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return Error{SLUICE_ERROR_OUT_OF_MEMORY, kThrown, "out of memory", ""};
    } catch (const std::exception&) {
        return Error{SLUICE_ERROR_INTERNAL, kThrown, "an exception", ""};
    }
}

std::string frames(std::uint64_t count) {
    return fmt::format("{} frame{}", count, count == 1 ? "" : "s");
}

/// One renderer after the other, and the numbers and the scene that they share.
class FluidHostImpl final : public FluidHost {
  public:
    FluidHostImpl(const PluginLibrary& library, FluidHostConfig config)
        : library_(library), config_(std::move(config)), recovery_(config_.recovery) {}

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
    [[nodiscard]] Status submit(const Screen& screen, const FrameInput& input) override {
        return caught([&]() -> Status {
            ++without_fluid_;
            if (Status status = revive(); !status) {
                return status;
            }
            Status status = life_->submit(screen, input);
            submitted_ = status ? base_ + life_->frame() : submitted_;
            return judged(std::move(status));
        });
    }
    [[nodiscard]] Status composite(const Screen& screen) override {
        return caught([&]() -> Status {
            if (recovery_.down()) {
                return whileDown("composite");
            }
            Status status = life_->composite(screen);
            if (status) {
                without_fluid_ = 0;
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

  private:
    /// Without recovery the present renderer answers for itself, whatever has become of it.
    [[nodiscard]] bool recovers() const { return config_.recovery.attempts > 0; }
    template <typename Body>
    [[nodiscard]] Status caught(Body body);
    [[nodiscard]] Status begin();
    [[nodiscard]] Status beginWithScene();
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
    void log(SluiceLogLevel level, const std::string& text);

    const PluginLibrary& library_;
    FluidHostConfig config_;
    Recovery recovery_;
    KeptScene scene_;
    SluiceRendererInfo info_{};  ///< of the present renderer, or else of the last
    std::unique_ptr<RendererLife> life_;
    std::uint64_t base_ = 0;  ///< numbers that earlier renderers have spent
    std::uint64_t submitted_ = 0;
    std::uint32_t renderers_ = 0;
    std::uint64_t without_fluid_ = 0;  ///< submits since the last composite
    std::uint64_t down_since_ns_ = 0;
    std::string cause_;
};

/// What ran out in the middle of a frame may have left the hand-off half done, so that renderer is not asked again.
template <typename Body>
Status FluidHostImpl::caught(Body body) {
    Status status = withoutThrowing(body);
    if (!status && status.error().thing == kThrown) {
        const Status told = withoutThrowing([&]() -> Status {
            fault(status.error());
            return {};
        });
        if (!told && life_ && recovers()) {
            recovery_.fault();  // all that is lost is its line in the log
        }
    }
    return status;
}

Status FluidHostImpl::begin() {
    FluidHostConfig config = config_;
    if (config.fault && base_ > 0) {
        config.fault->frame -= std::min(config.fault->frame, base_);
        if (config.fault->frame == 0) {
            config.fault.reset();
        }
    }
    auto life = std::make_unique<RendererLife>(config);
    if (Status status = life->start(library_); !status) {
        return status;
    }
    info_ = life->info();
    life_ = std::move(life);
    ++renderers_;
    return {};
}

Status FluidHostImpl::beginWithScene() {
    if (Status status = begin(); !status) {
        return status;
    }
    if (const auto environment = scene_.environment()) {
        if (Status status = life_->setEnvironment(&*environment); !status) {
            return status;
        }
    }
    const auto particles = scene_.particles();
    return particles ? life_->setParticles(*particles) : Status{};
}

Status FluidHostImpl::replaceImages(std::uint32_t width, std::uint32_t height) {
    if (Status status = checkExtent(width, height); !status) {
        return status;
    }
    config_.width = width;
    config_.height = height;
    if (recovery_.down()) {
        // A size is a new beginning: what had no room at the last one may have it at this.
        recovery_.forget();
        return tryAgain();
    }
    Status status = life_->resize(width, height);
    if (status) {
        info_ = life_->info();
    }
    return judged(std::move(status));
}

template <typename Call, typename Value>
Status FluidHostImpl::give(Call call, const Value& value) {
    Status status = recovery_.down() ? Status{} : judged(call());
    const bool refused = !status && status.error().code == SLUICE_ERROR_INVALID_ARGUMENT;
    if (recovers() && !refused) {
        scene_.keep(value);
    }
    return status;
}

Status FluidHostImpl::revive() {
    switch (recovery_.nextFrame()) {
        case Recovery::Step::None:
            return {};
        case Recovery::Step::Wait:
        case Recovery::Step::GivenUp:
            return whileDown("submit");
        case Recovery::Step::Try:
            break;
    }
    return tryAgain();
}

Status FluidHostImpl::tryAgain() {
    if (life_) {
        base_ += life_->numbersSpent();
        life_.reset();
    }
    const std::uint64_t began = monotonicNanoseconds();
    const Status status = withoutThrowing([this] { return beginWithScene(); });
    if (!status) {
        life_.reset();
    }
    recovery_.tried(status.ok());
    const auto ms = [](std::uint64_t from) { return static_cast<double>(monotonicNanoseconds() - from) * 1e-6; };
    if (status) {
        log(SLUICE_LOG_WARNING,
            fmt::format("renderer: here again after {} without fluid and {:.0f} ms, of which its creation took {:.0f} "
                        "ms (try {} of {})",
                        frames(without_fluid_ - std::min<std::uint64_t>(without_fluid_, 1)), ms(down_since_ns_),
                        ms(began), recovery_.tries(), config_.recovery.attempts));
        return {};
    }
    cause_ = status.error().message();
    const std::string next = recovery_.givenUp() ? std::string("given up; destroy the FluidHost and create it again")
                                                 : fmt::format("the next one in {}", frames(recovery_.framesToGo()));
    log(SLUICE_LOG_WARNING, fmt::format("renderer: try {} of {} failed, {}: {}", recovery_.tries(),
                                        config_.recovery.attempts, next, cause_));
    return whileDown("submit");
}

Status FluidHostImpl::judged(Status status) {
    if (!status && life_ && life_->fault()) {
        fault(*life_->fault());
    }
    return status;
}

void FluidHostImpl::fault(const Error& cause) {
    if (!recovers() || !life_ || recovery_.down()) {
        return;
    }
    recovery_.fault();
    down_since_ns_ = monotonicNanoseconds();
    cause_ = cause.message();
    log(SLUICE_LOG_WARNING,
        recovery_.givenUp()
            ? fmt::format("renderer: useless once more after {} tries, given up: {}", recovery_.tries(), cause_)
            : fmt::format("renderer: useless from frame {} on, created again in {} (try {} of {}): {}", submitted_ + 1,
                          frames(recovery_.framesToGo()), recovery_.tries() + 1, config_.recovery.attempts, cause_));
}

Error FluidHostImpl::whileDown(const char* call) const {
    return Error{SLUICE_ERROR_DEVICE_LOST, call, "there is no renderer: " + cause_,
                 recovery_.givenUp() ? "destroy the FluidHost and create it again" : "it is created again"};
}

void FluidHostImpl::log(SluiceLogLevel level, const std::string& text) {
    // The renderer's threads may log, too, and its services let one line through at a time.
    if (life_) {
        life_->log(level, text);
    } else if (config_.log) {
        config_.log(level, text);
    }
}

Result<SluiceFrameStats> FluidHostImpl::stats(std::uint64_t frame) {
    SluiceFrameStats found{};
    const Status status = caught([&]() -> Status {
        if (recovers() && (recovery_.down() || frame <= base_)) {
            return Error{SLUICE_ERROR_DEVICE_LOST, "stats", fmt::format("the renderer of frame {} is gone", frame), ""};
        }
        Result<SluiceFrameStats> stats = life_->stats(frame - base_);
        if (!stats) {
            return judged(stats.error());
        }
        found = stats.value();
        found.frame = frame;
        return {};
    });
    if (!status) {
        return status.error();
    }
    return found;
}

}  // namespace

Result<std::unique_ptr<FluidHost>> FluidHost::create(const PluginLibrary& library, const FluidHostConfig& config) {
    if (Status status = checkConfig(config); !status) {
        return status.error();
    }
    std::unique_ptr<FluidHostImpl> host;
    const Status status = withoutThrowing([&] {
        host = std::make_unique<FluidHostImpl>(library, config);
        return host->start();
    });
    if (!status) {
        return status.error();
    }
    return std::unique_ptr<FluidHost>(std::move(host));
}

}  // namespace sluice::host
