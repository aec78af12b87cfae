// SPDX-License-Identifier: MIT
#include "passes/tiles.hpp"

#include <shaders/tiles_comp.h>

#include <array>
#include <cmath>
#include <utility>

namespace sluice::vk {
namespace {

constexpr std::uint32_t kInvocations = 64;
/// Bytes before the list: the indirect dispatch and the number of tiles.
constexpr VkDeviceSize kHeaderBytes = 16;
/// What the blur of thickness reaches beyond the fluid: texels of the reduced resolution. The outline is closed by two
/// (reach of its kernel there), and shading reads one further.
constexpr std::uint32_t kThicknessMargin = 3;

constexpr std::uint32_t tilesAlong(std::uint32_t texels) {
    return (texels + kTileTexels - 1) / kTileTexels;
}

/// Push constants of tiles.comp.
struct Push {
    std::uint32_t count_x, count_y, side, margin;
};

void clear(const PassContext& context, VkImage image, float value) {
    if (image == VK_NULL_HANDLE) {
        return;
    }
    const VkClearColorValue colour{{value, value, value, value}};
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    context.device.fn.vkCmdClearColorImage(context.commands, image, VK_IMAGE_LAYOUT_GENERAL, &colour, 1, &range);
}

void clearOutside(const PassContext& context) {
    clear(context, context.images[PlanImage::DepthB].image(), 1e30F);
    clear(context, context.images[PlanImage::Normal].image(), 0.0F);
    clear(context, context.images[PlanImage::ThicknessSums].image(), 0.0F);
    clear(context, context.images[PlanImage::OpticalSums].image(), 0.0F);
    clear(context, context.images[PlanImage::SceneDepth].image(), 1e30F);
    clear(context, context.targets.fluid_colour.image, 0.0F);
    clear(context, context.targets.fluid_depth.image, 1.0F);
    clear(context, context.targets.fluid_normal.image, 0.0F);
    clear(context, context.targets.fluid_thickness.image, 0.0F);
}

}  // namespace

VkDeviceSize tileListBytes(std::uint32_t width, std::uint32_t height) {
    return kHeaderBytes + VkDeviceSize{tilesAlong(width)} * tilesAlong(height) * sizeof(std::uint32_t);
}

Result<TilesPass> TilesPass::create(const Device& device) {
    constexpr std::array bindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE};
    auto pipeline = createCompute(device, {"tiles", tiles_comp, bindings, sizeof(Push), {}});
    if (!pipeline) {
        return pipeline.error();
    }
    return TilesPass{std::move(pipeline).value()};
}

void TilesPass::record(const PassContext& context) const {
    const Device& device = context.device;
    const bool thick = findImage(context.plan, PlanImage::Thickness) != nullptr;
    context.timer.begin(context.commands, {"tiles", context.pixels(), context.pixels() * 4, false, thick ? 2U : 1U});
    constexpr std::array<std::uint32_t, 4> kNone{0, 1, 1, 0};
    device.fn.vkCmdUpdateBuffer(context.commands, context.images.surface_tiles.buffer(), 0, sizeof kNone, kNone.data());
    if (thick) {
        device.fn.vkCmdUpdateBuffer(context.commands, context.images.thickness_tiles.buffer(), 0, sizeof kNone,
                                    kNone.data());
    }
    clearOutside(context);
    order(context, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
          VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
          VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);

    const auto list = [&](const Buffer& tiles, std::uint32_t width, std::uint32_t height, std::uint32_t scale,
                          std::uint32_t margin) {
        const std::array bindings{uniform(context.arena.constants()), readBuffer(tiles.buffer()),
                                  sampled(context.images[PlanImage::DepthA].view())};
        context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, bindings);
        const Push push{tilesAlong(width), tilesAlong(height), kTileTexels * scale, margin * scale};
        device.fn.vkCmdPushConstants(context.commands, pipeline.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push,
                                     &push);
        dispatchOver(context, push.count_x * push.count_y, 1, kInvocations, 1);
    };
    list(context.images.surface_tiles, context.plan.width, context.plan.height, 1, 0);
    if (thick) {
        const Image& thickness = context.images[PlanImage::Thickness];
        const auto scale = static_cast<std::uint32_t>(std::lround(1.0F / context.frame.fluid.thickness_scale));
        list(context.images.thickness_tiles, thickness.width(), thickness.height(), scale, kThicknessMargin);
    }
    context.timer.end(context.commands);
    order(context, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
          VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
          VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
}

}  // namespace sluice::vk
