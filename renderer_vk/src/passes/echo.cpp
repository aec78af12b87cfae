// SPDX-License-Identifier: MIT
#include "passes/echo.hpp"

#include <shaders/clear_comp.h>
#include <shaders/echo_comp.h>

#include <array>
#include <utility>

namespace sluice::vk {
namespace {

constexpr std::uint32_t kTile = 16;
constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

}  // namespace

Result<EchoPass> EchoPass::create(const Device& device) {
    constexpr std::array bindings{kSampled, kSampled, kStorage, kStorage};
    auto pipeline = createCompute(device, {"echo", echo_comp, bindings, 0, {}});
    if (!pipeline) {
        return pipeline.error();
    }
    return EchoPass{std::move(pipeline).value()};
}

void EchoPass::record(const PassContext& context) const {
    const FrameTargets& targets = context.targets;
    context.timer.begin(context.commands, {"echo", context.pixels(), context.pixels() * (4 + 4 + 8 + 4), false, 1});
    const std::array bindings{sampled(targets.host_colour.view), sampled(targets.host_depth.view),
                              storage(targets.fluid_colour.view), storage(targets.fluid_depth.view)};
    context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, bindings);
    dispatchOver(context, context.plan.width, context.plan.height, kTile, kTile);
    context.timer.end(context.commands);
}

Result<ClearPass> ClearPass::create(const Device& device) {
    constexpr std::array bindings{kStorage, kStorage, kStorage, kStorage};
    auto pipeline = createCompute(device, {"clear", clear_comp, bindings, 0, {}});
    if (!pipeline) {
        return pipeline.error();
    }
    return ClearPass{std::move(pipeline).value()};
}

void ClearPass::record(const PassContext& context) const {
    const FrameTargets& targets = context.targets;
    const auto orNothing = [&](const ImageRef& image) {
        return storage(image.view != VK_NULL_HANDLE ? image.view : context.images.nothing_to_write.view());
    };
    context.timer.begin(context.commands, {"clear", context.pixels(), context.pixels() * (8 + 4), false, 1});
    const std::array bindings{storage(targets.fluid_colour.view), storage(targets.fluid_depth.view),
                              orNothing(targets.fluid_normal), orNothing(targets.fluid_thickness)};
    context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, bindings);
    dispatchOver(context, context.plan.width, context.plan.height, kTile, kTile);
    context.timer.end(context.commands);
}

}  // namespace sluice::vk
