// SPDX-License-Identifier: MIT
#include "plan/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "plan/check_ranges.hpp"
#include "sluice/roles.hpp"

namespace sluice::vk {
namespace {

/// What the scene needs, decided once; every pass below follows from it.
struct Wants {
    bool filter, normals, thickness, blur, foam, host_colour, environment, looks;
};

bool anyPositive(std::span<const float, 3> values) {
    return std::any_of(values.begin(), values.end(), [](float value) { return value > 0.0F; });
}

Wants wantsOf(const SluiceSceneNeeds& needs) {
    const SluiceFluid& fluid = needs.fluid;
    const bool shaded = fluid.view == SLUICE_VIEW_FLUID;
    const auto asked = [&](SluiceImageRole role) { return (needs.outputs & SLUICE_ROLE_BIT(role)) != 0; };
    Wants wants{};
    wants.normals = shaded || fluid.view == SLUICE_VIEW_NORMAL || asked(SLUICE_IMAGE_FLUID_NORMAL);
    wants.foam = shaded && fluid.foam > 0.0F;
    wants.looks = shaded && needs.other_look_count > 0;
    wants.thickness =
        wants.looks || wants.foam || fluid.view == SLUICE_VIEW_THICKNESS || asked(SLUICE_IMAGE_FLUID_THICKNESS) ||
        (shaded && (anyPositive(fluid.absorption) || anyPositive(fluid.scatter_colour) || fluid.refraction != 0));
    wants.filter = fluid.filter == SLUICE_FILTER_NARROW_RANGE && fluid.filter_iterations > 0 &&
                   fluid.filter_sigma > 0.0F && fluid.filter_max_pixels > 0 &&
                   (wants.normals || fluid.view == SLUICE_VIEW_DEPTH);
    wants.blur = wants.thickness && fluid.thickness_blur > 0.0F;
    wants.host_colour = shaded && fluid.refraction != 0;
    wants.environment = shaded && fluid.reflection != 0 && needs.has_environment_map != 0;
    return wants;
}

std::string filterOmission(const SluiceFluid& fluid) {
    if (fluid.filter == SLUICE_FILTER_NONE) {
        return "the scene asks for no filter";
    }
    if (fluid.filter_iterations == 0) {
        return "no iterations are asked for";
    }
    if (!(fluid.filter_sigma > 0.0F) || fluid.filter_max_pixels == 0) {
        return "its kernel has no width";
    }
    return "neither normals nor the depth view are wanted";
}

std::string thicknessReason(const SluiceSceneNeeds& needs) {
    const SluiceFluid& fluid = needs.fluid;
    if (fluid.view == SLUICE_VIEW_THICKNESS) {
        return "the thickness view shows it";
    }
    if (fluid.view == SLUICE_VIEW_FLUID) {
        if (needs.other_look_count > 0) {
            return "the fluids absorb light, each its own";
        }
        if (anyPositive(fluid.absorption)) {
            return "the fluid absorbs light";
        }
        if (anyPositive(fluid.scatter_colour)) {
            return "the fluid scatters light";
        }
        if (fluid.refraction != 0) {
            return "refraction needs the length of the path";
        }
        if (fluid.foam > 0.0F) {
            return "foam is seen as far as the scene lets it";
        }
    }
    return "the host reads FLUID_THICKNESS";
}

class Builder {
  public:
    explicit Builder(const SluiceSceneNeeds& needs) : needs_(needs), wants_(wantsOf(needs)) {
        plan_.width = needs.width;
        plan_.height = needs.height;
        plan_.view = static_cast<SluiceView>(needs.fluid.view);
    }

    Plan build() {
        if (plan_.view == SLUICE_VIEW_ECHO) {
            return single(PassId::Echo, {PlanImage::HostColour, PlanImage::HostDepth}, "the echo view is asked for",
                          "the echo view shows no fluid");
        }
        plan_.outputs = needs_.outputs & kOptionalFluidRoles;
        if (needs_.particle_count == 0) {
            return single(PassId::Clear, {}, "there are no particles", "there are no particles");
        }
        surface();
        thickness();
        foam();
        shade();
        omit(PassId::Echo, "the view is not echo");
        omit(PassId::Clear, "there are particles");
        return std::move(plan_);
    }

  private:
    void keep(PassId id, std::vector<PlanImage> reads, std::vector<PlanImage> writes, std::uint32_t dispatches,
              std::string reason) {
        plan_.passes.push_back({id, std::move(reads), std::move(writes), dispatches, std::move(reason)});
    }
    void omit(PassId id, std::string reason) { plan_.omitted.push_back({id, std::move(reason)}); }
    void image(PlanImage id, SluiceFormat format, std::uint32_t divisor = 1) {
        plan_.images.push_back(
            {id, format, (plan_.width + divisor - 1) / divisor, (plan_.height + divisor - 1) / divisor});
    }
    std::vector<PlanImage> outputs() const {
        std::vector<PlanImage> result{PlanImage::FluidColour, PlanImage::FluidDepth};
        if ((plan_.outputs & SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL)) != 0) {
            result.push_back(PlanImage::FluidNormal);
        }
        if ((plan_.outputs & SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_THICKNESS)) != 0) {
            result.push_back(PlanImage::FluidThickness);
        }
        return result;
    }

    Plan single(PassId id, const std::vector<PlanImage>& reads, const std::string& kept, const std::string& left_out) {
        for (std::uint8_t other = 0; other < static_cast<std::uint8_t>(PassId::Count); ++other) {
            if (static_cast<PassId>(other) == id) {
                keep(id, reads, outputs(), 1, kept);
            } else {
                omit(static_cast<PassId>(other), left_out);
            }
        }
        return std::move(plan_);
    }

    void surface() {
        image(PlanImage::DepthA, SLUICE_FORMAT_R32F);
        plan_.ellipsoids = needs_.fluid.ellipsoids != 0;
        keep(PassId::SplatDepth, {}, {PlanImage::DepthA}, 3,
             fmt::format("every view of the fluid needs its depth{}", plan_.ellipsoids ? "; of ellipsoids" : ""));
        tiles();
        if (wants_.filter) {
            plan_.filter_iterations = needs_.fluid.filter_iterations;
            image(PlanImage::DepthB, SLUICE_FORMAT_R32F);
            // Each iteration is x then y, so that the depth is back in DepthA; the clean-up moves it to DepthB.
            plan_.surface = PlanImage::DepthB;
            keep(PassId::Filter, {PlanImage::DepthA, PlanImage::SurfaceTiles}, {PlanImage::DepthA, PlanImage::DepthB},
                 2 * plan_.filter_iterations + 1,
                 fmt::format("narrow-range, {} x (x, y), then a 2-D clean-up", plan_.filter_iterations));
        } else {
            omit(PassId::Filter, filterOmission(needs_.fluid));
        }
        if (wants_.normals) {
            image(PlanImage::Normal, SLUICE_FORMAT_RGBA16F);
            keep(PassId::Normals, {plan_.surface, PlanImage::SurfaceTiles}, {PlanImage::Normal}, 1,
                 plan_.view == SLUICE_VIEW_FLUID    ? "shading needs normals"
                 : plan_.view == SLUICE_VIEW_NORMAL ? "the normal view shows them"
                                                    : "the host reads FLUID_NORMAL");
        } else {
            omit(PassId::Normals, "nothing that is shown or read needs normals");
        }
    }

    void tiles() {
        std::vector<PlanImage> writes{PlanImage::SurfaceTiles};
        if (wants_.thickness) {
            writes.push_back(PlanImage::ThicknessTiles);
        }
        const auto dispatches = static_cast<std::uint32_t>(writes.size());
        keep(PassId::Tiles, {PlanImage::DepthA}, std::move(writes), dispatches,
             "later passes run only where there is fluid");
    }

    void thickness() {
        if (!wants_.thickness) {
            omit(PassId::SplatThickness, plan_.view == SLUICE_VIEW_FLUID
                                             ? "no absorption, no scattering and no refraction"
                                             : "nothing that is shown or read needs thickness");
            omit(PassId::BlurThickness, "there is no thickness to blur");
            return;
        }
        const auto divisor = static_cast<std::uint32_t>(std::lround(1.0F / needs_.fluid.thickness_scale));
        image(PlanImage::Thickness, SLUICE_FORMAT_R32F, divisor);
        image(PlanImage::SceneDepth, SLUICE_FORMAT_R32F, divisor);
        std::vector<PlanImage> splat_writes{PlanImage::SceneDepth, PlanImage::Thickness};
        if (wants_.looks) {
            plan_.several_looks = true;
            image(PlanImage::OpticalDepth, SLUICE_FORMAT_RGBA32F, divisor);
            splat_writes.push_back(PlanImage::OpticalDepth);
        }
        keep(PassId::SplatThickness, {PlanImage::HostDepth, PlanImage::ThicknessTiles}, std::move(splat_writes), 3,
             thicknessReason(needs_));
        if (wants_.blur) {
            image(PlanImage::ThicknessSums, SLUICE_FORMAT_RG32F, divisor);
            std::vector<PlanImage> reads{PlanImage::Thickness, plan_.surface, PlanImage::ThicknessTiles};
            std::vector<PlanImage> writes{PlanImage::ThicknessSums, PlanImage::Thickness};
            if (wants_.looks) {
                image(PlanImage::OpticalSums, SLUICE_FORMAT_RGBA32F, divisor);
                reads.push_back(PlanImage::OpticalDepth);
                writes.insert(writes.end(), {PlanImage::OpticalSums, PlanImage::OpticalDepth});
            }
            keep(PassId::BlurThickness, std::move(reads), std::move(writes), 2,
                 "removes the grain of single particles");
        } else {
            omit(PassId::BlurThickness, "thickness_blur is 0");
        }
    }

    void foam() {
        if (!wants_.foam) {
            omit(PassId::SplatFoam, "no foam is made, or none is asked for");
            return;
        }
        const PlannedImage& like = *findImage(plan_, PlanImage::Thickness);
        plan_.images.push_back({PlanImage::Foam, SLUICE_FORMAT_R32F, like.width, like.height});
        keep(PassId::SplatFoam, {PlanImage::SceneDepth, plan_.surface}, {PlanImage::Foam}, 2,
             "the simulation makes foam");
    }

    void shade() {
        std::vector<PlanImage> reads{plan_.surface, PlanImage::HostDepth, PlanImage::SurfaceTiles};
        if (wants_.normals) {
            reads.push_back(PlanImage::Normal);
        }
        if (wants_.thickness) {
            reads.push_back(PlanImage::Thickness);
        }
        if (wants_.foam) {
            reads.push_back(PlanImage::Foam);
        }
        if (wants_.looks) {
            reads.push_back(PlanImage::OpticalDepth);
        }
        if (wants_.host_colour) {
            reads.push_back(PlanImage::HostColour);
            plan_.refraction = true;
        }
        if (wants_.environment) {
            reads.push_back(PlanImage::Environment);
            plan_.environment_map = true;
        }
        plan_.reflection = plan_.view == SLUICE_VIEW_FLUID && needs_.fluid.reflection != 0;
        std::string reason = "a debug view of one buffer";
        if (plan_.view == SLUICE_VIEW_FLUID) {
            reason =
                fmt::format("{}, reflection {}", plan_.refraction ? "refraction of the host's colour" : "no refraction",
                            !plan_.reflection       ? "off"
                            : plan_.environment_map ? "of the environment map"
                                                    : "of the procedural sky");
        }
        keep(PassId::Shade, std::move(reads), outputs(), 1, std::move(reason));
    }

    const SluiceSceneNeeds& needs_;
    Wants wants_;
    Plan plan_;
};

}  // namespace

Result<Plan> makePlan(const SluiceSceneNeeds& needs) {
    if (Status status = checkRanges(needs); !status) {
        return status.error();
    }
    return Builder(needs).build();
}

const PlannedPass* findPass(const Plan& plan, PassId pass) {
    const auto found = std::find_if(plan.passes.begin(), plan.passes.end(),
                                    [&](const PlannedPass& candidate) { return candidate.id == pass; });
    return found == plan.passes.end() ? nullptr : &*found;
}

const PlannedImage* findImage(const Plan& plan, PlanImage image) {
    const auto found = std::find_if(plan.images.begin(), plan.images.end(),
                                    [&](const PlannedImage& candidate) { return candidate.id == image; });
    return found == plan.images.end() ? nullptr : &*found;
}

}  // namespace sluice::vk
