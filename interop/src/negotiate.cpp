// SPDX-License-Identifier: MIT
#include "sluice/negotiate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "negotiate_timeline.hpp"
#include "obstacles.hpp"
#include "sluice/format.hpp"
#include "sluice/roles.hpp"
#include "sluice/uuid.hpp"

namespace sluice {

namespace {

using Reasons = std::vector<Reason>;

/// A count from across the ABI is bounded before it indexes anything.
std::uint32_t deviceUuidCount(const SluiceHostCapabilities& gl) {
    return std::min(gl.device_uuid_count, SLUICE_MAX_DEVICE_UUIDS);
}

/// All 16 bytes: real UUIDs contain zero bytes, at which a string comparison would stop.
bool sameUuid(const std::uint8_t* a, const std::uint8_t* b) {
    return std::memcmp(a, b, SLUICE_UUID_SIZE) == 0;
}

/// Index of the GL device UUID that the Vulkan device has, or the count if none.
std::uint32_t matchingDevice(const SluiceHostCapabilities& gl, const SluiceRendererCapabilities& vk) {
    const std::uint32_t count = deviceUuidCount(gl);
    std::uint32_t index = 0;
    while (index < count && !sameUuid(gl.device_uuids[index], vk.device_uuid)) {
        ++index;
    }
    return index;
}

/// C strings from across the ABI need not be terminated.
template <std::size_t Size>
std::string_view text(const char (&field)[Size]) {
    return {field, strnlen(field, Size)};
}

Status checkDevice(const SluiceHostCapabilities& gl, const SluiceRendererCapabilities& vk, Reasons& reasons) {
    const std::uint32_t count = deviceUuidCount(gl);
    const std::uint32_t index = matchingDevice(gl, vk);
    std::string why;
    std::string remedy;
    if (count == 0) {
        why = "OpenGL reports no device UUID";
        remedy = "use an OpenGL driver with GL_EXT_memory_object";
    } else if (index == count) {
        why = fmt::format("none of the {} OpenGL device UUIDs (the first is {}, {}) equals {} of the Vulkan device {}",
                          count, uuidText(gl.device_uuids[0]), text(gl.renderer), uuidText(vk.device_uuid),
                          text(vk.device_name));
        remedy =
            "run both APIs on one GPU: check DRI_PRIME, VK_DRIVER_FILES and the __NV_PRIME_RENDER_OFFLOAD variables";
    } else if (!sameUuid(gl.driver_uuid, vk.driver_uuid)) {
        why = fmt::format("device UUIDs are equal, but the OpenGL driver UUID is {} and the Vulkan one {}",
                          uuidText(gl.driver_uuid), uuidText(vk.driver_uuid));
        remedy = "use the OpenGL and Vulkan drivers of one vendor and version";
    } else {
        reasons.push_back({"device", true,
                           fmt::format("OpenGL device UUID {} of {} and the driver UUID equal those of {}", index + 1,
                                       count, text(vk.device_name))});
        return {};
    }
    reasons.push_back({"device", false, why});
    return Error{SLUICE_ERROR_DEVICE_MISMATCH, "device", std::move(why), std::move(remedy)};
}

Status checkMemory(const SluiceHostCapabilities& gl, const SluiceRendererCapabilities& vk, Reasons& reasons) {
    std::string why = obstacles({{gl.has_memory_object != 0, "GL_EXT_memory_object is missing"},
                                 {gl.has_memory_object_fd != 0, "GL_EXT_memory_object_fd is missing"},
                                 {vk.has_external_memory_fd != 0, "VK_KHR_external_memory_fd is missing"}});
    if (why.empty()) {
        reasons.push_back({"memory opaque fd", true, "Vulkan exports and OpenGL imports opaque file descriptors"});
        return {};
    }
    reasons.push_back({"memory opaque fd", false, why});
    return Error{SLUICE_ERROR_UNSUPPORTED, "shared memory", std::move(why),
                 "use drivers that share memory by file descriptor, such as Mesa 21.3 or later"};
}

/// Why `format` cannot serve `role` on these two sides; empty if it can.
std::string formatObstacle(const SluiceHostCapabilities& gl, const SluiceRendererCapabilities& vk, SluiceImageRole role,
                           SluiceFormat format, std::uint32_t failed_formats) {
    const std::uint32_t bit = formatBit(format);
    // Fluid images come out of a compute pass. R32F for HOST_DEPTH is drawn by a fullscreen pass of the host; every
    // other host image is filled by glCopyTexSubImage2D, which needs no framebuffer with the format.
    const bool stored = (SLUICE_ROLE_BIT(role) & kFluidRoles) != 0;
    const bool drawn = role == SLUICE_IMAGE_HOST_DEPTH && format == SLUICE_FORMAT_R32F;
    return obstacles(
        {{(failed_formats & bit) == 0, "its canary round trip failed on this machine"},
         {(gl.texture_formats & bit) != 0, "OpenGL has no such texture"},
         {(vk.exportable_formats & bit) != 0, "Vulkan cannot export such an image"},
         {!stored || (vk.storage_formats & bit) != 0, "Vulkan cannot write it from a compute pass"},
         {!drawn || gl.has_framebuffer_object != 0, "OpenGL has no framebuffer objects to draw linear depth with"},
         {!drawn || (gl.attachment_formats & bit) != 0, "an OpenGL framebuffer with it is not complete"}});
}

Result<SluiceFormat> chooseFormat(const SluiceHostCapabilities& gl, const SluiceRendererCapabilities& vk,
                                  SluiceImageRole role, SluiceFormat forced, std::uint32_t failed_formats,
                                  Reasons& reasons) {
    const std::vector<SluiceFormat> candidates = formatCandidates(role);
    SluiceFormat chosen = SLUICE_FORMAT_NONE;
    std::string first_obstacle;
    for (const SluiceFormat candidate : candidates) {
        const std::string_view name = findFormat(candidate)->name;
        Reason reason{fmt::format("{} {}", toString(role), name), false, {}};
        const std::string obstacle = formatObstacle(gl, vk, role, candidate, failed_formats);
        if (forced != SLUICE_FORMAT_NONE && candidate != forced) {
            reason.why = fmt::format("{} was asked for", findFormat(forced)->name);
        } else if (chosen != SLUICE_FORMAT_NONE) {
            reason.why = fmt::format("{} comes first and is possible", findFormat(chosen)->name);
        } else if (obstacle.empty()) {
            chosen = candidate;
            reason.accepted = true;
            reason.why =
                forced != SLUICE_FORMAT_NONE ? "asked for and possible" : "the first candidate that both sides can do";
        } else {
            first_obstacle += fmt::format("{}{}: {}", first_obstacle.empty() ? "" : "; ", name, obstacle);
            reason.why = obstacle;
        }
        reasons.push_back(std::move(reason));
    }
    if (chosen != SLUICE_FORMAT_NONE) {
        return chosen;
    }
    return Error{SLUICE_ERROR_UNSUPPORTED, fmt::format("{} has no format left", toString(role)),
                 std::move(first_obstacle),
                 forced != SLUICE_FORMAT_NONE ? "do not force the format of host depth"
                                              : "update the drivers, or leave this output out"};
}

Status checkRequest(const NegotiationRequest& request, Reasons& reasons) {
    const auto refuse = [&reasons](std::string thing, std::string why, std::string remedy) -> Status {
        reasons.push_back({thing, false, why});
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, std::move(thing), std::move(why), std::move(remedy)};
    };
    if (static_cast<std::uint32_t>(request.timeline) >= SLUICE_TIMELINE_KIND_COUNT) {
        return refuse("requested timeline", fmt::format("{} is no timeline kind", static_cast<int>(request.timeline)),
                      "use a value of SluiceTimelineKind");
    }
    if ((request.outputs & ~kFluidRoles) != 0) {
        return refuse("requested outputs", fmt::format("mask {:#x} names roles that are not FLUID_*", request.outputs),
                      "set bits of FLUID_* roles only");
    }
    const auto depths = formatCandidates(SLUICE_IMAGE_HOST_DEPTH);
    if (request.host_depth != SLUICE_FORMAT_NONE && std::ranges::find(depths, request.host_depth) == depths.end()) {
        const FormatInfo* const info = findFormat(static_cast<std::uint32_t>(request.host_depth));
        return refuse("requested HOST_DEPTH",
                      info != nullptr ? fmt::format("{} cannot carry host depth", info->name)
                                      : fmt::format("{} is no format", static_cast<int>(request.host_depth)),
                      "use D32F or R32F");
    }
    return {};
}

Result<Agreement> negotiateInto(const SluiceHostCapabilities& gl, const SluiceRendererCapabilities& vk,
                                const NegotiationRequest& request, Reasons& reasons) {
    if (Status status = checkRequest(request, reasons); !status) {
        return status.error();
    }
    if (Status status = checkDevice(gl, vk, reasons); !status) {
        return status.error();
    }
    if (Status status = checkMemory(gl, vk, reasons); !status) {
        return status.error();
    }
    Agreement agreement;
    const std::uint32_t shared = kAlwaysSharedRoles | request.outputs;
    for (std::uint32_t index = 0; index < SLUICE_IMAGE_CANARY; ++index) {
        const auto role = static_cast<SluiceImageRole>(index);
        if ((shared & SLUICE_ROLE_BIT(role)) == 0) {
            continue;
        }
        const SluiceFormat forced = role == SLUICE_IMAGE_HOST_DEPTH ? request.host_depth : SLUICE_FORMAT_NONE;
        auto format = chooseFormat(gl, vk, role, forced, request.failed_formats, reasons);
        if (!format) {
            return format.error();
        }
        agreement.formats[index] = format.value();
    }
    agreement.host_depth_encoding =
        agreement.formats[SLUICE_IMAGE_HOST_DEPTH] == SLUICE_FORMAT_D32F ? SLUICE_DEPTH_WINDOW : SLUICE_DEPTH_LINEAR;
    auto timeline = chooseTimeline(gl, vk, request.timeline, reasons);
    if (!timeline) {
        return timeline.error();
    }
    agreement.timeline = timeline.value();
    return agreement;
}

}  // namespace

std::vector<SluiceFormat> formatCandidates(SluiceImageRole role) {
    switch (role) {
        case SLUICE_IMAGE_HOST_COLOUR:
            return {SLUICE_FORMAT_RGBA8};
        case SLUICE_IMAGE_HOST_DEPTH:
            return {SLUICE_FORMAT_D32F, SLUICE_FORMAT_R32F};
        case SLUICE_IMAGE_FLUID_COLOUR:
            return {SLUICE_FORMAT_RGBA16F, SLUICE_FORMAT_RGBA8};
        case SLUICE_IMAGE_FLUID_DEPTH:
            return {SLUICE_FORMAT_R32F};
        case SLUICE_IMAGE_FLUID_NORMAL:
            return {SLUICE_FORMAT_RGBA16F, SLUICE_FORMAT_RGBA32F};
        case SLUICE_IMAGE_FLUID_THICKNESS:
            return {SLUICE_FORMAT_R16F, SLUICE_FORMAT_R32F};
        case SLUICE_IMAGE_CANARY:
        case SLUICE_IMAGE_ROLE_COUNT:
            break;
    }
    return {};
}

bool sameDevice(const SluiceHostCapabilities& gl, const SluiceRendererCapabilities& vk) {
    return matchingDevice(gl, vk) < deviceUuidCount(gl) && sameUuid(gl.driver_uuid, vk.driver_uuid);
}

Result<Agreement> negotiate(const SluiceHostCapabilities& gl, const SluiceRendererCapabilities& vk,
                            const NegotiationRequest& request, std::vector<Reason>* reasons_on_failure) {
    Reasons reasons;
    auto result = negotiateInto(gl, vk, request, reasons);
    if (result) {
        result.value().reasons = std::move(reasons);
    } else if (reasons_on_failure != nullptr) {
        *reasons_on_failure = std::move(reasons);
    }
    return result;
}

}  // namespace sluice
