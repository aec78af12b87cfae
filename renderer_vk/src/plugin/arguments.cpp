// SPDX-License-Identifier: MIT
#include "plugin/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string_view>

#include "sluice/abi_sizes.hpp"
#include "sluice/format.hpp"
#include "sluice/roles.hpp"
#include "sluice/timeline.hpp"

namespace sluice::vk {
namespace {

Error invalid(std::string_view thing, std::string detail, std::string_view remedy = "") {
    return {SLUICE_ERROR_INVALID_ARGUMENT, std::string(thing), std::move(detail), std::string(remedy)};
}

Status checkFinite(std::span<const float> values, std::string_view name) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!std::isfinite(values[i])) {
            return invalid(fmt::format("{}[{}]", name, i), fmt::format("{} is not a finite number", values[i]));
        }
    }
    return {};
}

}  // namespace

Status checkServices(const SluiceHostServices* host) {
    if (Status status = checkAbiStruct(host, "host"); !status) {
        return status;
    }
    if ((host->abi_version >> 16U) != SLUICE_ABI_MAJOR) {
        return Error{SLUICE_ERROR_ABI_MISMATCH, "host",
                     fmt::format("its ABI major is {}, this renderer's {}", host->abi_version >> 16U, SLUICE_ABI_MAJOR),
                     "use a host and a renderer of one release"};
    }
    return {};
}

Status checkCreateHeader(const SluiceCreateInfo* info) {
    if (Status status = checkAbiStruct(info, "info"); !status) {
        return status;
    }
    if (Status status = checkAbiStruct(&info->host, "info.host"); !status) {
        return status;
    }
    if (info->host.device_uuid_count > SLUICE_MAX_DEVICE_UUIDS) {
        return invalid("info.host.device_uuid_count",
                       fmt::format("{} exceeds {}", info->host.device_uuid_count, SLUICE_MAX_DEVICE_UUIDS));
    }
    return {};
}

SluiceCreateInfo readCreateInfo(const SluiceCreateInfo& info) {
    SluiceCreateInfo known = readAbiStruct(info);
    known.host = readAbiStruct(known.host);
    return known;
}

Status checkSize(std::uint32_t width, std::uint32_t height) {
    if (width < 1 || width > SLUICE_MAX_EXTENT || height < 1 || height > SLUICE_MAX_EXTENT) {
        return invalid("size", fmt::format("{}x{} is outside 1..{}", width, height, SLUICE_MAX_EXTENT));
    }
    return {};
}

Status checkCreateInfo(const SluiceHostServices* host, const SluiceCreateInfo* info) {
    if (Status status = checkServices(host); !status) {
        return status;
    }
    if (host->share_image == nullptr || host->retire_image == nullptr || host->canary == nullptr) {
        return invalid("host", "share_image, retire_image or canary is NULL");
    }
    if (Status status = checkCreateHeader(info); !status) {
        return status;
    }
    if (Status status = checkSize(info->width, info->height); !status) {
        return status;
    }
    if (info->image_sets < 1 || info->image_sets > SLUICE_MAX_IMAGE_SETS) {
        return invalid("image_sets", fmt::format("{} is outside 1..{}", info->image_sets, SLUICE_MAX_IMAGE_SETS));
    }
    if (info->timeline >= SLUICE_TIMELINE_KIND_COUNT) {
        return invalid("timeline", fmt::format("{} is not a SluiceTimelineKind", info->timeline));
    }
    if ((info->outputs & ~kFluidRoles) != 0) {
        return invalid("outputs", fmt::format("{:#x} has bits that are not FLUID_* roles", info->outputs));
    }
    if (info->host_depth_format != SLUICE_FORMAT_NONE && findFormat(info->host_depth_format) == nullptr) {
        return invalid("host_depth_format", fmt::format("{} is not a SluiceFormat", info->host_depth_format));
    }
    return {};
}

Status checkParticles(const SluiceParticles* particles) {
    if (Status status = checkAbiStruct(particles, "particles"); !status) {
        return status;
    }
    if (particles->count == 0) {
        return {};
    }
    if (particles->position == nullptr) {
        return invalid("particles.position", fmt::format("it is NULL with a count of {}", particles->count));
    }
    if (!std::isfinite(particles->radius) || particles->radius <= 0.0F) {
        return invalid("particles.radius", fmt::format("{} is not a positive length in metres", particles->radius));
    }
    if (Status status = checkFinite({particles->position, std::size_t{3} * particles->count}, "particles.position");
        !status) {
        return status;
    }
    const SluiceParticles known = readAbiStruct(*particles);
    const std::span fluids(known.fluid, known.fluid != nullptr ? known.count : 0);
    const auto unknown =
        std::find_if(fluids.begin(), fluids.end(), [](std::uint32_t i) { return i >= SLUICE_MAX_FLUIDS; });
    if (unknown != fluids.end()) {
        return invalid(fmt::format("particles.fluid[{}]", unknown - fluids.begin()),
                       fmt::format("{} is above {}", *unknown, SLUICE_MAX_FLUIDS - 1));
    }
    return {};
}

Status checkEnvironment(const SluiceEnvironment* environment) {
    if (environment == nullptr) {
        return {};
    }
    if (Status status = checkAbiStruct(environment, "environment"); !status) {
        return status;
    }
    if (environment->pixels == nullptr) {
        return invalid("environment.pixels", "it is NULL", "pass a NULL environment for the procedural sky");
    }
    return checkSize(environment->width, environment->height);
}

Status checkNeeds(const SluiceSceneNeeds* needs) {
    return checkAbiStruct(needs, "needs");
}

Status checkFrameOrder(const SluiceFrame& frame, const FrameExpectation& expected) {
    if (frame.frame <= expected.submitted || frame.frame > expected.attempted + 1) {
        return invalid("frame.frame",
                       fmt::format("{} came after frame {}, {} was expected", frame.frame, expected.attempted,
                                   expected.attempted + 1),
                       "number frames from 1 without gaps");
    }
    if (const std::uint32_t set = imageSetOf(frame.frame, expected.image_sets); frame.image_set != set) {
        return invalid("frame.image_set", fmt::format("{} is not (frame - 1) % image_sets = {}", frame.image_set, set));
    }
    if (frame.wait_value != gbufferWritten(frame.frame)) {
        return invalid("frame.wait_value",
                       fmt::format("{} is not 2k-1 = {}", frame.wait_value, gbufferWritten(frame.frame)));
    }
    if (frame.signal_value != fluidWritten(frame.frame)) {
        return invalid("frame.signal_value",
                       fmt::format("{} is not k = {}", frame.signal_value, fluidWritten(frame.frame)));
    }
    return {};
}

Status checkFrameValues(const SluiceFrame& frame, const FrameExpectation& expected) {
    constexpr std::uint32_t kFlags =
        SLUICE_FRAME_SKIP_WAIT | SLUICE_FRAME_SKIP_SIMULATION_WAIT | SLUICE_FRAME_CAPTURE_DEPTH;
    if ((frame.flags & ~kFlags) != 0) {
        return invalid("frame.flags", fmt::format("{:#x} has bits that are not SluiceFrameFlags", frame.flags));
    }
    if (const std::uint32_t unshared = frame.outputs & ~(expected.outputs | kAlwaysMadeFluidRoles); unshared != 0) {
        return invalid("frame.outputs", fmt::format("{:#x} are roles that create was not asked to share", unshared));
    }
    if (frame.other_look_count >= SLUICE_MAX_FLUIDS) {
        return invalid("frame.other_look_count",
                       fmt::format("{} is above {}", frame.other_look_count, SLUICE_MAX_FLUIDS - 1));
    }
    for (std::uint32_t i = 0; i < frame.other_look_count; ++i) {
        for (const float absorption : frame.other_looks[i].absorption) {
            // Negated so that NaN fails as well.
            if (!(absorption >= 0.0F && absorption <= 1e6F)) {
                return invalid(fmt::format("frame.other_looks[{}].absorption", i),
                               fmt::format("{} is outside [0, 1e6]", absorption));
            }
        }
    }
    struct Field {
        std::span<const float> values;
        std::string_view name;
    };
    const SluiceCamera& camera = frame.camera;
    const SluiceSky& sky = frame.sky;
    const Field fields[] = {
        {camera.view, "camera.view"},
        {camera.projection, "camera.projection"},
        {{&camera.near_plane, 1}, "camera.near_plane"},
        {{&camera.far_plane, 1}, "camera.far_plane"},
        {sky.zenith, "sky.zenith"},
        {sky.horizon, "sky.horizon"},
        {sky.ground, "sky.ground"},
        {sky.to_sun, "sky.to_sun"},
        {sky.sun_radiance, "sky.sun_radiance"},
    };
    for (const Field& field : fields) {
        if (Status status = checkFinite(field.values, field.name); !status) {
            return status;
        }
    }
    if (camera.near_plane <= 0.0F || camera.far_plane <= camera.near_plane) {
        return invalid("camera planes",
                       fmt::format("near {} and far {} are not 0 < near < far", camera.near_plane, camera.far_plane));
    }
    return {};
}

}  // namespace sluice::vk
