// SPDX-License-Identifier: MIT
// The plan in words.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "plan/plan.hpp"
#include "sluice/format.hpp"

namespace sluice::vk {
namespace {

std::string names(const std::vector<PlanImage>& images) {
    std::string text;
    for (const PlanImage image : images) {
        text += text.empty() ? "" : ", ";
        text += toString(image);
    }
    return text.empty() ? "particles" : text;
}

std::string passLine(const Plan& plan, PassId id) {
    if (const PlannedPass* pass = findPass(plan, id)) {
        return fmt::format("+ {:<15} {}; reads {}; writes {}; {} {}", toString(id), pass->reason, names(pass->reads),
                           names(pass->writes), pass->dispatches, pass->dispatches == 1 ? "dispatch" : "dispatches");
    }
    const auto omitted = std::find_if(plan.omitted.begin(), plan.omitted.end(),
                                      [&](const OmittedPass& candidate) { return candidate.id == id; });
    return fmt::format("- {:<15} left out: {}", toString(id),
                       omitted == plan.omitted.end() ? "not considered" : omitted->reason);
}

}  // namespace

std::vector<std::string> explain(const Plan& plan) {
    std::vector<std::string> lines;
    for (std::uint8_t id = 0; id < static_cast<std::uint8_t>(PassId::Count); ++id) {
        lines.push_back(passLine(plan, static_cast<PassId>(id)));
    }
    for (const PlannedImage& image : plan.images) {
        const FormatInfo* info = findFormat(static_cast<std::uint32_t>(image.format));
        const std::uint64_t bytes =
            info == nullptr ? 0 : std::uint64_t{info->bytes_per_texel} * image.width * image.height;
        lines.push_back(fmt::format("  image {:<15} {} {}x{}, {:.2f} MiB", toString(image.id),
                                    info == nullptr ? "?" : info->name, image.width, image.height,
                                    static_cast<double>(bytes) / (1024.0 * 1024.0)));
    }
    return lines;
}

std::string_view toString(PassId pass) {
    switch (pass) {
        case PassId::SplatDepth:
            return "splat_depth";
        case PassId::Tiles:
            return "tiles";
        case PassId::Filter:
            return "filter";
        case PassId::Normals:
            return "normals";
        case PassId::SplatThickness:
            return "splat_thickness";
        case PassId::BlurThickness:
            return "blur_thickness";
        case PassId::SplatFoam:
            return "splat_foam";
        case PassId::Shade:
            return "shade";
        case PassId::Echo:
            return "echo";
        case PassId::Clear:
            return "clear";
        case PassId::Count:
            break;
    }
    return "?";
}

std::string_view toString(PlanImage image) {
    switch (image) {
        case PlanImage::DepthA:
            return "depth A";
        case PlanImage::DepthB:
            return "depth B";
        case PlanImage::Normal:
            return "normal";
        case PlanImage::Thickness:
            return "thickness";
        case PlanImage::ThicknessSums:
            return "thickness sums";
        case PlanImage::Foam:
            return "foam";
        case PlanImage::OpticalDepth:
            return "optical depth";
        case PlanImage::OpticalSums:
            return "optical sums";
        case PlanImage::SceneDepth:
            return "scene depth";
        case PlanImage::HostColour:
            return "HOST_COLOUR";
        case PlanImage::HostDepth:
            return "HOST_DEPTH";
        case PlanImage::Environment:
            return "environment";
        case PlanImage::SurfaceTiles:
            return "surface tiles";
        case PlanImage::ThicknessTiles:
            return "thickness tiles";
        case PlanImage::FluidColour:
            return "FLUID_COLOUR";
        case PlanImage::FluidDepth:
            return "FLUID_DEPTH";
        case PlanImage::FluidNormal:
            return "FLUID_NORMAL";
        case PlanImage::FluidThickness:
            return "FLUID_THICKNESS";
        case PlanImage::Count:
            break;
    }
    return "?";
}

}  // namespace sluice::vk
