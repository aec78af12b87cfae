// SPDX-License-Identifier: MIT
#include "negotiate_timeline.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "obstacles.hpp"
#include "sluice/format.hpp"

namespace sluice {

namespace {

/// Why the two sides cannot do `kind`; empty if they can.
std::string timelineObstacle(const SluiceHostCapabilities& gl, const SluiceRendererCapabilities& vk,
                             SluiceTimelineKind kind) {
    const Requirement semaphore{gl.has_semaphore != 0, "GL_EXT_semaphore is missing"};
    const Requirement semaphore_fd{gl.has_semaphore_fd != 0, "GL_EXT_semaphore_fd is missing"};
    const Requirement counter{vk.has_timeline_semaphore != 0, "Vulkan has no timeline semaphores"};
    switch (kind) {
        case SLUICE_TIMELINE_NATIVE:
            return obstacles(
                {semaphore,
                 semaphore_fd,
                 {gl.has_timeline_semaphore != 0, "GL_NV_timeline_semaphore is missing"},
                 counter,
                 {vk.exports_timeline_fd != 0, "Vulkan cannot export a timeline semaphore as an opaque fd"}});
        case SLUICE_TIMELINE_BINARY:
            return obstacles({semaphore,
                              semaphore_fd,
                              {vk.exports_binary_fd != 0, "Vulkan cannot export a binary semaphore as an opaque fd"}});
        case SLUICE_TIMELINE_BRIDGED:
            return obstacles({{gl.has_sync != 0, "OpenGL has no fences (GL_ARB_sync)"}, counter});
        default:
            return {};
    }
}

std::string_view timelineMerit(SluiceTimelineKind kind) {
    switch (kind) {
        case SLUICE_TIMELINE_NATIVE:
            return "both sides share a timeline semaphore";
        case SLUICE_TIMELINE_BINARY:
            return "both sides share binary semaphores";
        case SLUICE_TIMELINE_BRIDGED:
            return "OpenGL fences and Vulkan timeline semaphores are there";
        case SLUICE_TIMELINE_UNSYNCHRONISED:
            return "asked for: nothing orders the two sides, results are wrong on purpose";
        default:
            return "glFinish and an idle queue work everywhere";
    }
}

}  // namespace

Result<SluiceTimelineKind> chooseTimeline(const SluiceHostCapabilities& gl, const SluiceRendererCapabilities& vk,
                                          SluiceTimelineKind forced, std::vector<Reason>& reasons) {
    constexpr std::array kOrder{SLUICE_TIMELINE_NATIVE, SLUICE_TIMELINE_BINARY, SLUICE_TIMELINE_BRIDGED,
                                SLUICE_TIMELINE_FINISH, SLUICE_TIMELINE_UNSYNCHRONISED};
    SluiceTimelineKind chosen = SLUICE_TIMELINE_AUTO;
    SluiceTimelineKind possible = SLUICE_TIMELINE_AUTO;
    std::string forced_obstacle;
    for (const SluiceTimelineKind kind : kOrder) {
        Reason reason{fmt::format("timeline {}", toString(kind)), false, {}};
        const std::string obstacle = timelineObstacle(gl, vk, kind);
        if (possible == SLUICE_TIMELINE_AUTO && obstacle.empty() && kind != SLUICE_TIMELINE_UNSYNCHRONISED) {
            possible = kind;
        }
        if (forced != SLUICE_TIMELINE_AUTO && kind != forced) {
            reason.why = fmt::format("{} was asked for", toString(forced));
        } else if (forced == SLUICE_TIMELINE_AUTO && kind == SLUICE_TIMELINE_UNSYNCHRONISED) {
            reason.why = "never chosen: it has no waits";
        } else if (chosen != SLUICE_TIMELINE_AUTO) {
            reason.why = fmt::format("{} comes first and is possible", toString(chosen));
        } else if (obstacle.empty()) {
            chosen = kind;
            reason.accepted = true;
            reason.why = timelineMerit(kind);
        } else {
            forced_obstacle = obstacle;
            reason.why = obstacle;
        }
        reasons.push_back(std::move(reason));
    }
    if (chosen != SLUICE_TIMELINE_AUTO) {
        return chosen;
    }
    return Error{SLUICE_ERROR_UNSUPPORTED, fmt::format("timeline {}", toString(forced)), std::move(forced_obstacle),
                 fmt::format("ask for auto, which takes {} here", toString(possible))};
}

}  // namespace sluice
