// SPDX-License-Identifier: MIT
// The calls of a program, each to the renderer that is there.
#include "sluice/host_gl/fluid_host.hpp"

#include <fmt/format.h>

#include <mutex>

#include "frame/check_info.hpp"
#include "frame/descriptor_note.hpp"
#include "frame/recovering_host.hpp"
#include "sluice/host_gl/context.hpp"

namespace sluice::host {

RecoveringHost::~RecoveringHost() {
    if (faults_.pending()) {
        (void)withoutThrowing([this]() -> Status {
            log(SLUICE_LOG_WARNING, "the host fault's frame never came: nothing was injected");
            return {};
        });
    }
}

Status RecoveringHost::checkContext() {
    const bool told = !context_loss_.empty();
    if (!told) {
        context_loss_ = faults_.contextLost() ? "it has been reset, an injected fault" : contextLoss();
    }
    if (context_loss_.empty()) {
        return {};
    }
    const Error error{SLUICE_ERROR_DEVICE_LOST, "GL context", std::string(context_loss_),
                      "create another context, and a FluidHost in it"};
    if (!told) {
        if (life_) {
            life_->contextLost();
        }
        log(SLUICE_LOG_ERROR, error.message());
    }
    return error;
}

Status RecoveringHost::replaceImages(std::uint32_t width, std::uint32_t height) {
    if (Status status = checkExtent(width, height); !status) {
        return status;
    }
    config_.width = width;
    config_.height = height;
    if (Status status = checkContext(); !status) {
        return status;
    }
    if (recovery_.down()) {
        // A size is a new beginning: what had no room at the last one may have it at this.
        recovery_.allowTriesAgain();
        return tryAgain();
    }
    Status status = withDescriptorNote(life_->resize(width, height));
    if (status) {
        info_ = life_->info();
    }
    return judged(std::move(status));
}

Result<SluiceFrameStats> RecoveringHost::stats(std::uint64_t frame) {
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

namespace {

/// The renderer's threads, the watch's and the host's may all have something to say: one line at a time.
FluidHostConfig serialised(FluidHostConfig config) {
    if (config.log) {
        config.log = [mutex = std::make_shared<std::mutex>(), log = config.log](SluiceLogLevel level,
                                                                                std::string_view text) {
            const std::lock_guard lock(*mutex);
            log(level, text);
        };
    }
    return config;
}

}  // namespace

Result<std::unique_ptr<FluidHost>> FluidHost::create(const PluginLibrary& library, const FluidHostConfig& config) {
    if (Status status = checkConfig(config); !status) {
        return status.error();
    }
    std::unique_ptr<RecoveringHost> host;
    const Status status = withoutThrowing([&] {
        host = std::make_unique<RecoveringHost>(library, serialised(config));
        return host->start();
    });
    if (!status) {
        return status.error();
    }
    return std::unique_ptr<FluidHost>(std::move(host));
}

}  // namespace sluice::host
