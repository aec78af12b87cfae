// SPDX-License-Identifier: MIT
#include "passes/splat.hpp"

#include <shaders/scene_depth_comp.h>
#include <shaders/splat_depth_frag.h>
#include <shaders/splat_thickness_frag.h>
#include <shaders/splat_vert.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "device/structs.hpp"

namespace sluice::vk {
namespace {

/// A triangle around a square costs half the set-up and twice the fragments. On llvmpipe the two meet where a sphere's
/// rectangle is about this wide in target texels; on a GPU the difference is small either way.
constexpr float kLargeTexels = 16.0F;

/// Spheres of one frame share one path: the projected diameter at the distance of the eye's focus, the world origin's
/// depth, stands for all of them. A wrong guess costs time, never pixels.
bool large(const PassContext& context, float texels_per_pixel) {
    const float(&view)[16] = context.frame.camera.view;
    const float(&projection)[16] = context.frame.camera.projection;
    const float distance = std::max(-view[14], context.frame.camera.near_plane);
    const float radius = context.particles.radius * context.frame.fluid.splat_radius;
    const float pixels = radius * projection[5] / distance * static_cast<float>(context.plan.height);
    return pixels * texels_per_pixel > kLargeTexels;
}

struct Target {
    PlanImage id;
    float clear;
};

void draw(const PassContext& context, const Target& target, const Pipeline& pipeline, std::uint32_t vertices,
          std::span<const Binding> bindings) {
    const Device& device = context.device;
    const Image& image = context.images[target.id];
    auto attachment = vkStruct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    attachment.imageView = image.view();
    attachment.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.clearValue.color.float32[0] = target.clear;
    auto rendering = vkStruct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    rendering.renderArea = {{0, 0}, {image.width(), image.height()}};
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &attachment;
    device.fn.vkCmdBeginRendering(context.commands, &rendering);
    context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline, bindings);
    const VkViewport viewport{0.0F, 0.0F, static_cast<float>(image.width()), static_cast<float>(image.height()),
                              0.0F, 1.0F};
    device.fn.vkCmdSetViewport(context.commands, 0, 1, &viewport);
    device.fn.vkCmdSetScissor(context.commands, 0, 1, &rendering.renderArea);
    device.fn.vkCmdDraw(context.commands, context.particles.count * vertices, 1, 0, 0);
    device.fn.vkCmdEndRendering(context.commands);
}

constexpr std::array kDepthBindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
constexpr std::array kThicknessBindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE};

Result<Pipeline> depthPipeline(const Device& device, std::uint32_t vertices) {
    const std::array<std::uint32_t, 2> constants{vertices, 0};
    return createSplat(device, {"splat_depth", splat_vert, splat_depth_frag, kDepthBindings, VK_FORMAT_R32_SFLOAT,
                                VK_BLEND_OP_MIN, constants});
}

Result<Pipeline> thicknessPipeline(const Device& device, std::uint32_t vertices) {
    const std::array<std::uint32_t, 2> constants{vertices, 1};
    return createSplat(device, {"splat_thickness", splat_vert, splat_thickness_frag, kThicknessBindings,
                                VK_FORMAT_R32_SFLOAT, VK_BLEND_OP_ADD, constants});
}

}  // namespace

Result<SplatDepthPass> SplatDepthPass::create(const Device& device) {
    auto small = depthPipeline(device, 3);
    if (!small) {
        return small.error();
    }
    auto large = depthPipeline(device, 6);
    if (!large) {
        return large.error();
    }
    return SplatDepthPass{std::move(small).value(), std::move(large).value()};
}

void SplatDepthPass::record(const PassContext& context) const {
    const bool use_large = sluice::vk::large(context, 1.0F);
    const std::uint64_t count = context.particles.count;
    context.timer.begin(context.commands, {"splat_depth", count, count * 12 + context.pixels() * 4, true, 1});
    const std::array bindings{uniform(context.arena.constants()), readBuffer(context.particles.position)};
    draw(context, {PlanImage::DepthA, 1e30F}, use_large ? large : small, use_large ? 6 : 3, bindings);
    context.timer.end(context.commands);
    closeAttachment(context, PlanImage::DepthA);
}

Result<SplatThicknessPass> SplatThicknessPass::create(const Device& device) {
    auto small = thicknessPipeline(device, 3);
    if (!small) {
        return small.error();
    }
    auto large = thicknessPipeline(device, 6);
    if (!large) {
        return large.error();
    }
    constexpr std::array bindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    auto scene = createCompute(device, {"scene_depth", scene_depth_comp, bindings, 0, {}});
    if (!scene) {
        return scene.error();
    }
    return SplatThicknessPass{std::move(small).value(), std::move(large).value(), std::move(scene).value()};
}

void SplatThicknessPass::record(const PassContext& context) const {
    const float scale = std::round(1.0F / context.frame.fluid.thickness_scale);
    const bool use_large = sluice::vk::large(context, 1.0F / scale);
    const Image& image = context.images[PlanImage::Thickness];
    const std::uint64_t count = context.particles.count;
    context.timer.begin(
        context.commands,
        {"splat_thickness", count,
         count * 12 + context.pixels() * 4 + std::uint64_t{image.width()} * image.height() * 12, true, 2});
    const std::array scene_bindings{
        uniform(context.arena.constants()), readBuffer(context.images.thickness_tiles.buffer()),
        sampled(context.targets.host_depth.view), storage(context.images[PlanImage::SceneDepth].view())};
    context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, scene, scene_bindings);
    dispatchTiles(context, context.images.thickness_tiles);
    beforeFragments(context);
    const std::array bindings{uniform(context.arena.constants()), readBuffer(context.particles.position),
                              sampled(context.images[PlanImage::SceneDepth].view())};
    draw(context, {PlanImage::Thickness, 0.0F}, use_large ? large : small, use_large ? 6 : 3, bindings);
    context.timer.end(context.commands);
    closeAttachment(context, PlanImage::Thickness);
}

}  // namespace sluice::vk
