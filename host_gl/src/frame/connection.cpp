// SPDX-License-Identifier: MIT
#include "frame/connection.hpp"

#include <fmt/format.h>

#include <utility>

#include "frame/check_info.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/format.hpp"
#include "sluice/host_gl/context.hpp"
#include "timeline/fallback.hpp"
#include "timeline/faulty.hpp"

namespace sluice::host {

namespace {

SluiceCreateInfo createInfo(const FluidHostConfig& config, const SluiceHostCapabilities& host,
                            SluiceTimelineKind timeline) {
    auto info = sized<SluiceCreateInfo>();
    info.width = config.width;
    info.height = config.height;
    info.image_sets = config.image_sets;
    info.timeline = timeline;
    info.validation = config.validation ? 1 : 0;
    info.outputs = config.outputs;
    info.host_depth_format = config.host_depth;
    info.host = host;
    return info;
}

/// Whether a resize that failed with `code` had waited for the frames in flight before. These codes can only come from
/// the new images; the others may mean that frames do not end, and nothing may be built on a wait that was perhaps not.
bool failedAfterTheWait(SluiceResult code) {
    return code == SLUICE_ERROR_UNSUPPORTED || code == SLUICE_ERROR_OUT_OF_MEMORY || code == SLUICE_ERROR_IMPORT ||
           code == SLUICE_ERROR_CANARY;
}

}  // namespace

Status Connection::attempt(const PluginLibrary& library, SluiceTimelineKind kind, Stage& stage) {
    stage = Stage::Renderer;
    capabilities = queryCapabilities();
    Result<Renderer> created =
        Renderer::create(library.api(), services.table(), createInfo(config, capabilities, kind));
    if (!created) {
        return created.error();
    }
    renderer = std::move(created).value();
    if (Status status = adoptImages(); !status) {
        return status;
    }
    const auto settled = static_cast<SluiceTimelineKind>(info.timeline);
    if (config.fault) {
        if (Status status = checkFault(*config.fault, settled); !status) {
            return status;
        }
    }
    sets.emplace(info.image_sets, services.images(), config.trace);
    if (config.ledger != nullptr) {
        feed.emplace(*config.ledger, settled, info.image_sets);
        tellImages();
        services.tellFeed(&*feed);
    }
    stage = Stage::Timeline;
    TimelineDeps deps;
    deps.api = &renderer.api();
    deps.renderer = renderer.handle();
    deps.trace = config.trace;
    deps.feed = feed ? &*feed : nullptr;
    deps.shares = shares ? &*shares : nullptr;
    deps.log = [this](SluiceLogLevel level, std::string_view text) { services.log(level, text); };
    Result<std::unique_ptr<HostTimeline>> made = makeHostTimeline(settled, deps);
    if (!made) {
        return made.error();
    }
    timeline = std::move(made).value();
    if (config.fault) {
        timeline = makeFaultyTimeline(std::move(timeline), *config.fault, deps);
    }
    stage = Stage::Done;
    return {};
}

Status Connection::open(const PluginLibrary& library) {
    Stage stage{};
    Status status = attempt(library, config.timeline, stage);
    if (stage == Stage::Timeline && config.timeline == SLUICE_TIMELINE_AUTO) {
        // Extensions that are advertised may still fail between two drivers. Only the next kind's renderer has the
        // semaphores that the next kind needs, so the renderer starts anew as well.
        auto failed = static_cast<SluiceTimelineKind>(info.timeline);
        for (const SluiceTimelineKind next : timelinesAfter(failed)) {
            services.log(SLUICE_LOG_WARNING, fmt::format("timeline {} failed at start-up, {} is next: {}",
                                                         toString(failed), toString(next), status.error().message()));
            close();
            failed = next;
            status = attempt(library, next, stage);
            if (status) {
                break;
            }
        }
    }
    if (!status) {
        return status;
    }
    services.log(SLUICE_LOG_INFO,
                 fmt::format("renderer {} {}: {} image sets of {}x{}, timeline {}", renderer.api().name,
                             renderer.api().version != nullptr ? renderer.api().version : "", info.image_sets,
                             info.width, info.height, toString(timeline->kind())));
    return {};
}

void Connection::close(bool drained) {
    // The bridge may still owe values that the renderer's queue waits for, so it drains before the renderer goes.
    timeline.reset();
    renderer = Renderer{};
    services.tellFeed(nullptr);
    if (feed && drained) {
        feed->imagesDestroyed(true);
    }
    feed.reset();
    if (shares) {
        shares->forget();
    }
    services.images().clear();
}

std::uint32_t Connection::sharedRoles() const {
    std::uint32_t roles = 0;
    for (std::uint32_t role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
        roles |= services.images().texture(role, 0) != 0 ? SLUICE_ROLE_BIT(role) : 0;
    }
    return roles;
}

void Connection::tellImages() {
    feed->imagesMade(sharedRoles());
    shares->imagesMade(info.capabilities, capabilities);
}

Status Connection::adoptImages() {
    Result<SluiceRendererInfo> answer = renderer.info();
    if (!answer) {
        return answer.error();
    }
    info = answer.value();
    if (Status status = checkInfo(info, config, services.images()); !status) {
        return status;
    }
    linear.reset();
    if (info.host_depth_encoding == SLUICE_DEPTH_LINEAR) {
        Result<LinearDepthPass> pass = LinearDepthPass::create(info.width, info.height);
        if (!pass) {
            return pass.error();
        }
        linear.emplace(std::move(pass).value());
    }
    return {};
}

Status Connection::resize(std::uint32_t width, std::uint32_t height) {
    Status status = renderer.resize(width, height);
    const bool drained = status || failedAfterTheWait(status.error().code);
    if (status) {
        config.width = width;
        config.height = height;
        status = adoptImages();
    }
    sets->reset();
    if (feed) {
        feed->imagesDestroyed(drained);
        if (status) {
            tellImages();
        } else {
            feed->imagesMade(0);
            shares->forget();
        }
    }
    if (!status) {
        services.images().clear();
    }
    return status;
}

}  // namespace sluice::host
