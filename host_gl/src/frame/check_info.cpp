// SPDX-License-Identifier: MIT
#include "frame/check_info.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "sluice/abi_sizes.hpp"
#include "sluice/format.hpp"
#include "sluice/simulation_arrays.hpp"

namespace sluice::host {

namespace {

Error brokenInfo(std::string detail) {
    return {SLUICE_ERROR_INTERNAL, "renderer info", std::move(detail), "the plugin is broken"};
}

Status checkSet(const SluiceRendererInfo& info, const ImageTable& images, std::uint32_t set, std::uint32_t needed) {
    for (std::uint32_t role = 0; role < SLUICE_IMAGE_CANARY; ++role) {
        const auto name = toString(static_cast<SluiceImageRole>(role));
        const ImportedImage* image = images.find(role, set);
        if (image == nullptr) {
            if ((needed & SLUICE_ROLE_BIT(role)) != 0 || info.formats[role] != SLUICE_FORMAT_NONE) {
                return brokenInfo(fmt::format("{} of set {} was never shared", name, set));
            }
            continue;
        }
        const SluiceImageExport& found = image->description();
        if (found.format != info.formats[role] || found.width != info.width || found.height != info.height) {
            return brokenInfo(fmt::format("{} of set {}: expected {}x{} in format {}, shared {}x{} in format {}", name,
                                          set, info.width, info.height, info.formats[role], found.width, found.height,
                                          found.format));
        }
    }
    return {};
}

Status checkSides(std::uint32_t width, std::uint32_t height, const char* what) {
    if (width == 0 || height == 0 || width > SLUICE_MAX_EXTENT || height > SLUICE_MAX_EXTENT) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, what,
                     fmt::format("expected 1..{} a side, found {}x{}", SLUICE_MAX_EXTENT, width, height), ""};
    }
    return {};
}

}  // namespace

Status checkExtent(std::uint32_t width, std::uint32_t height) {
    return checkSides(width, height, "size of the shared images");
}

Status checkConfig(const FluidHostConfig& config) {
    if (config.image_sets == 0 || config.image_sets > SLUICE_MAX_IMAGE_SETS) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "image_sets",
                     fmt::format("expected 1..{}, found {}", SLUICE_MAX_IMAGE_SETS, config.image_sets), ""};
    }
    if (config.fault && !possible(config.fault->kind, config.fault->direction)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "fault", "that kind is not possible in that direction",
                     "sluice/host_gl/fault_plan.hpp tells which are"};
    }
    return checkExtent(config.width, config.height);
}

Status checkPart(const SluiceParticles& particles) {
    if (Status status = checkAbiStruct(&particles, "particles"); !status) {
        return status;
    }
    if (particles.count != 0 && particles.position == nullptr) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "particles.position",
                     fmt::format("it is NULL with a count of {}", particles.count), ""};
    }
    if (particles.count != 0 && (!std::isfinite(particles.radius) || particles.radius <= 0.0F)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "particles.radius",
                     fmt::format("{} is not a positive length in metres", particles.radius), ""};
    }
    return {};
}

Status checkPart(const SluiceSimulation* simulation) {
    if (simulation == nullptr) {
        return {};
    }
    if (Status status = checkAbiStruct(simulation, "simulation"); !status) {
        return status;
    }
    return checkArrays(readAbiStruct(*simulation));
}

Status checkPart(const SluiceStart* start) {
    if (Status status = checkAbiStruct(start, "start"); !status) {
        return status;
    }
    return checkArrays(readAbiStruct(*start));
}

Status checkPart(const SluiceEnvironment* environment) {
    if (environment == nullptr) {
        return {};
    }
    if (Status status = checkAbiStruct(environment, "environment"); !status) {
        return status;
    }
    if (environment->pixels == nullptr) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "environment.pixels", "it is NULL",
                     "pass a NULL environment for the procedural sky"};
    }
    return checkSides(environment->width, environment->height, "size of the environment map");
}

Status checkInfo(const SluiceRendererInfo& info, const FluidHostConfig& config, const ImageTable& images) {
    if (info.image_sets != config.image_sets || info.width != config.width || info.height != config.height) {
        return brokenInfo(fmt::format("expected {} sets of {}x{}, found {} of {}x{}", config.image_sets, config.width,
                                      config.height, info.image_sets, info.width, info.height));
    }
    // Before anything makes an enumerator of one of these.
    if (info.timeline == SLUICE_TIMELINE_AUTO || info.timeline >= SLUICE_TIMELINE_KIND_COUNT) {
        return brokenInfo(fmt::format("{} is no timeline in use", info.timeline));
    }
    for (const std::uint32_t format : info.formats) {
        if (format >= SLUICE_FORMAT_COUNT) {
            return brokenInfo(fmt::format("{} is no format", format));
        }
    }
    if (info.host_depth_encoding != SLUICE_DEPTH_WINDOW && info.host_depth_encoding != SLUICE_DEPTH_LINEAR) {
        return brokenInfo(fmt::format("{} is no depth encoding", info.host_depth_encoding));
    }
    const std::uint32_t needed = SLUICE_ROLE_BIT(SLUICE_IMAGE_HOST_DEPTH) | SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_COLOUR) |
                                 SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_DEPTH) | config.outputs;
    for (std::uint32_t set = 0; set < info.image_sets; ++set) {
        if (Status status = checkSet(info, images, set, needed); !status) {
            return status;
        }
    }
    return {};
}

}  // namespace sluice::host
