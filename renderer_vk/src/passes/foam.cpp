// SPDX-License-Identifier: MIT
#include "passes/foam.hpp"

#include <shaders/splat_foam_frag.h>
#include <shaders/splat_foam_vert.h>

#include <array>
#include <utility>

namespace sluice::vk {
namespace {

constexpr std::array kBindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                               VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                               VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
/// Read of a particle: its centre, and four floats of whitewater.
constexpr std::uint64_t kBytes = (3 + 4) * sizeof(float);

constexpr std::array<VkFormat, 1> kTarget{VK_FORMAT_R32_SFLOAT};

}  // namespace

Result<SplatFoamPass> SplatFoamPass::create(const Device& device) {
    auto pipelines = splatPipelines(device,
                                    {.name = "splat_foam",
                                     .vertex = splat_foam_vert,
                                     .fragment = splat_foam_frag,
                                     .bindings = kBindings,
                                     .targets = kTarget,
                                     .blend = VK_BLEND_OP_ADD},
                                    true);
    if (!pipelines) {
        return pipelines.error();
    }
    return SplatFoamPass{std::move(pipelines).value()};
}

void SplatFoamPass::record(const PassContext& context) const {
    const Image& image = context.images[PlanImage::Foam];
    const std::uint64_t count = context.particles.count;
    const std::uint64_t texels = std::uint64_t{image.width()} * image.height();
    context.timer.begin(context.commands, {"splat_foam", count, count * kBytes + texels * 12, true, 2});
    beforeFragments(context);
    const std::array bindings{uniform(context.arena.constants()), readBuffer(context.particles.position),
                              sampled(context.images[PlanImage::SceneDepth].view()),
                              sampled(context.images[context.plan.surface].view()),
                              readBuffer(context.particles.whitewater)};
    constexpr std::array targets{SplatTarget{PlanImage::Foam, 0.0F}};
    drawSplats(context, targets, pipelines, bindings);
    context.timer.end(context.commands);
    closeAttachment(context, PlanImage::Foam);
}

}  // namespace sluice::vk
