// SPDX-License-Identifier: MIT
#include "passes/filter.hpp"

#include <shaders/filter_clean_comp.h>
#include <shaders/filter_line_comp.h>

#include <array>
#include <utility>

namespace sluice::vk {
namespace {

/// Texels of a workgroup. Rows are fetched whole in both directions, so that the tile of y is 8 wide as well.
struct Tile {
    std::uint32_t x, y;
};
constexpr Tile kTileX{64, 4};
constexpr Tile kTileY{8, 32};
constexpr std::uint32_t kTileClean = 16;

constexpr std::array kBindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                               VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};

Result<Pipeline> linePipeline(const Device& device, const char* name, std::uint32_t along, Tile tile) {
    const std::array<std::uint32_t, 3> constants{along, tile.x, tile.y};
    return createCompute(device, {name, filter_line_comp, kBindings, 0, constants});
}

}  // namespace

Result<FilterPass> FilterPass::create(const Device& device) {
    auto x = linePipeline(device, "filter_x", 0, kTileX);
    if (!x) {
        return x.error();
    }
    auto y = linePipeline(device, "filter_y", 1, kTileY);
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
    const auto step = [&](const Pipeline& pipeline, PlanImage from, PlanImage to, Tile tile) {
        const std::array bindings{uniform(context.arena.constants()), sampled(context.images[from].view()),
                                  storage(context.images[to].view())};
        context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, bindings);
        dispatchOver(context, context.plan.width, context.plan.height, tile.x, tile.y);
        betweenDispatches(context);
    };
    context.timer.begin(context.commands,
                        {"filter", context.pixels(), context.pixels() * 8 * dispatches, false, dispatches});
    for (std::uint32_t iteration = 0; iteration < context.plan.filter_iterations; ++iteration) {
        step(along_x, PlanImage::DepthA, PlanImage::DepthB, kTileX);
        step(along_y, PlanImage::DepthB, PlanImage::DepthA, kTileY);
    }
    step(clean, PlanImage::DepthA, PlanImage::DepthB, {kTileClean, kTileClean});
    context.timer.end(context.commands);
}

}  // namespace sluice::vk
