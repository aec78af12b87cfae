// SPDX-License-Identifier: MIT
#include "passes/shade.hpp"

#include <shaders/shade_comp.h>

#include <cassert>
#include <utility>

namespace sluice::vk {
namespace {

bool wanted(const Plan& plan, SluiceImageRole role) {
    return (plan.outputs & SLUICE_ROLE_BIT(role)) != 0;
}

}  // namespace

ShadePass::Key ShadePass::keyOf(const Plan& plan) {
    const auto flag = [](bool value) { return value ? 1U : 0U; };
    return {static_cast<std::uint32_t>(plan.view),
            flag(findImage(plan, PlanImage::Normal) != nullptr),
            flag(findImage(plan, PlanImage::Thickness) != nullptr),
            flag(plan.refraction),
            plan.reflection ? 1U + flag(plan.environment_map) : 0U,
            flag(wanted(plan, SLUICE_IMAGE_FLUID_NORMAL)),
            flag(wanted(plan, SLUICE_IMAGE_FLUID_THICKNESS)),
            flag(findImage(plan, PlanImage::Foam) != nullptr),
            flag(plan.several_looks)};
}

Status ShadePass::prepare(const Device& device, const Plan& plan) {
    const Key key = keyOf(plan);
    if (pipelines_.contains(key)) {
        return {};
    }
    constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    constexpr std::array bindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                  VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  kSampled,
                                  kSampled,
                                  kSampled,
                                  kSampled,
                                  kSampled,
                                  kSampled,
                                  kStorage,
                                  kStorage,
                                  kStorage,
                                  kStorage,
                                  kSampled,
                                  kSampled};
    auto pipeline = createCompute(device, {"shade", shade_comp, bindings, 0, key});
    if (!pipeline) {
        return pipeline.error();
    }
    pipelines_.emplace(key, std::move(pipeline).value());
    return {};
}

void ShadePass::record(const PassContext& context) const {
    const auto found = pipelines_.find(keyOf(context.plan));
    assert(found != pipelines_.end());
    if (found == pipelines_.end()) {
        return;
    }
    const FrameTargets& targets = context.targets;
    const PassImages& images = context.images;
    const bool write_normal = wanted(context.plan, SLUICE_IMAGE_FLUID_NORMAL);
    const bool write_thickness = wanted(context.plan, SLUICE_IMAGE_FLUID_THICKNESS);
    const auto output = [&](bool used, const ImageRef& image) {
        return storage(used ? image.view : images.nothing_to_write.view());
    };
    const VkImageView environment =
        context.plan.environment_map ? images.readable(PlanImage::Environment) : images.nothing_to_read.view();
    const VkImageView colour = context.plan.refraction ? targets.host_colour.view : images.nothing_to_read.view();
    const std::array bindings{uniform(context.arena.constants()),
                              readBuffer(images.surface_tiles.buffer()),
                              sampled(images[context.plan.surface].view()),
                              sampled(targets.host_depth.view),
                              sampled(images.readable(PlanImage::Normal)),
                              sampled(images.readable(PlanImage::Thickness)),
                              sampled(colour),
                              sampled(environment),
                              storage(targets.fluid_colour.view),
                              storage(targets.fluid_depth.view),
                              output(write_normal, targets.fluid_normal),
                              output(write_thickness, targets.fluid_thickness),
                              sampled(images.readable(PlanImage::Foam)),
                              sampled(images.readable(PlanImage::OpticalDepth))};
    const Image& thickness = images[PlanImage::Thickness];
    const std::uint64_t bytes_per_pixel = 4U + 4U + (images[PlanImage::Normal] ? 8U : 0U) +
                                          (context.plan.refraction ? 4U : 0U) + 8U + 4U + (write_normal ? 8U : 0U) +
                                          (write_thickness ? 4U : 0U);
    context.timer.begin(context.commands,
                        {"shade", context.pixels(),
                         context.pixels() * bytes_per_pixel +
                             std::uint64_t{thickness.width()} * thickness.height() *
                                 ((images[PlanImage::Foam] ? 8U : 4U) + (context.plan.several_looks ? 16U : 0U)),
                         false, 1});
    context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, found->second, bindings);
    dispatchTiles(context, images.surface_tiles);
    context.timer.end(context.commands);
}

}  // namespace sluice::vk
