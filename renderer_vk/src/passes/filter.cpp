// SPDX-License-Identifier: MIT
#include "passes/filter.hpp"

#include <shaders/filter_clean_comp.h>
#include <shaders/filter_line_comp.h>

#include <array>
#include <utility>

namespace sluice::vk {
namespace {

constexpr std::array kBindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                               VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};

Result<Pipeline> linePipeline(const Device& device, const char* name, std::uint32_t along) {
    const std::array<std::uint32_t, 1> constants{along};
    return createCompute(device, {name, filter_line_comp, kBindings, 0, constants});
}

}  // namespace

Result<FilterPass> FilterPass::create(const Device& device) {
    auto x = linePipeline(device, "filter_x", 0);
    if (!x) {
        return x.error();
    }
    auto y = linePipeline(device, "filter_y", 1);
    if (!y) {
        return y.error();
    }
    auto clean = createCompute(device, {"filter_clean", filter_clean_comp, kBindings, 0, {}});
    if (!clean) {
        return clean.error();
    }
    return FilterPass{std::move(x).value(), std::move(y).value(), std::move(clean).value()};
}

void FilterPass::record(const PassContext& context) const {
    const std::uint32_t dispatches = 2 * context.plan.filter_iterations + 1;
    const auto step = [&](const Pipeline& pipeline, PlanImage from, PlanImage to) {
        const Buffer& tiles = context.images.surface_tiles;
        const std::array bindings{uniform(context.arena.constants()), readBuffer(tiles.buffer()),
                                  sampled(context.images[from].view()), storage(context.images[to].view())};
        context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, bindings);
        dispatchTiles(context, tiles);
        betweenDispatches(context);
    };
    context.timer.begin(context.commands,
                        {"filter", context.pixels(), context.pixels() * 8 * dispatches, false, dispatches});
    for (std::uint32_t iteration = 0; iteration < context.plan.filter_iterations; ++iteration) {
        step(along_x, PlanImage::DepthA, PlanImage::DepthB);
        step(along_y, PlanImage::DepthB, PlanImage::DepthA);
    }
    step(clean, PlanImage::DepthA, PlanImage::DepthB);
    context.timer.end(context.commands);
}

}  // namespace sluice::vk
