// SPDX-License-Identifier: MIT
#include "passes/splat.hpp"

#include <shaders/scene_depth_comp.h>
#include <shaders/splat_depth_frag.h>
#include <shaders/splat_ellipsoid_depth_frag.h>
#include <shaders/splat_ellipsoid_looks_vert.h>
#include <shaders/splat_ellipsoid_thickness_frag.h>
#include <shaders/splat_ellipsoid_thickness_looks_frag.h>
#include <shaders/splat_ellipsoid_vert.h>
#include <shaders/splat_looks_vert.h>
#include <shaders/splat_near_comp.h>
#include <shaders/splat_thickness_frag.h>
#include <shaders/splat_thickness_looks_frag.h>
#include <shaders/splat_vert.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "device/structs.hpp"
#include "simulation/anisotropy.hpp"

namespace sluice::vk {
namespace {

/// Invocations of a workgroup of splat_near.comp, and workgroups in x: devices promise 65535 each way.
constexpr std::uint32_t kNearInvocations = 256;
constexpr std::uint32_t kNearRow = 32768;

/// Where near_draw has the draw of points.
constexpr VkDeviceSize kPointsAt = sizeof(VkDrawIndirectCommand);

constexpr std::array kDepthBindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
constexpr std::array kThicknessBindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE};
/// And whose fluid each particle is of.
constexpr std::array kLooksBindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                    VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};

constexpr std::array<VkFormat, 1> kMetres{VK_FORMAT_R32_SFLOAT};
constexpr std::array<VkFormat, 2> kMetresAndOptical{VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT};

struct Stages {
    std::span<const std::uint32_t> vertex, fragment;
};
Stages thicknessStages(bool ellipsoids, bool several_looks) {
    if (several_looks) {
        return ellipsoids ? Stages{splat_ellipsoid_looks_vert, splat_ellipsoid_thickness_looks_frag}
                          : Stages{splat_looks_vert, splat_thickness_looks_frag};
    }
    return ellipsoids ? Stages{splat_ellipsoid_vert, splat_ellipsoid_thickness_frag}
                      : Stages{splat_vert, splat_thickness_frag};
}

/// What a splat is made of, and bytes of it.
VkBuffer splatsOf(const PassContext& context) {
    return context.plan.ellipsoids ? context.particles.ellipsoids : context.particles.position;
}
std::uint64_t splatBytes(const PassContext& context) {
    return context.plan.ellipsoids ? kEllipsoidFloats * sizeof(float) : 3 * sizeof(float);
}

/// Decides whether the indirect draw of triangles has any vertices in this frame.
void findNear(const PassContext& context, const Pipeline& pipeline) {
    // Triangles, then points. How many particles a simulation has may be known to the device alone.
    const std::array<VkDrawIndirectCommand, 2> draws{{{0, 1, 0, 0}, {context.particles.count, 1, 0, 0}}};
    VkBuffer near_draw = context.images.near_draw.buffer();
    const bool counted = context.particles.draw != VK_NULL_HANDLE;
    context.device.fn.vkCmdUpdateBuffer(context.commands, near_draw, 0, counted ? kPointsAt : sizeof draws,
                                        draws.data());
    if (counted) {
        const VkBufferCopy points{0, kPointsAt, sizeof(VkDrawIndirectCommand)};
        context.device.fn.vkCmdCopyBuffer(context.commands, context.particles.draw, near_draw, 1, &points);
    }
    order(context, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
          VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
          VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
              VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
    const std::array bindings{uniform(context.arena.constants()), readBuffer(splatsOf(context)), readBuffer(near_draw)};
    context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, bindings);
    const std::uint32_t groups = (context.particles.count + kNearInvocations - 1) / kNearInvocations;
    context.device.fn.vkCmdDispatch(context.commands, std::min(groups, kNearRow), (groups + kNearRow - 1) / kNearRow,
                                    1);
    order(context, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
          VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
}

}  // namespace

void drawSplats(const PassContext& context, std::span<const SplatTarget> targets, const SplatPipelines& pipelines,
                std::span<const Binding> bindings) {
    const Device& device = context.device;
    const Image& image = context.images[targets.front().id];
    std::vector<VkRenderingAttachmentInfo> attachments;
    for (const SplatTarget& target : targets) {
        auto attachment = vkStruct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
        attachment.imageView = context.images[target.id].view();
        attachment.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        attachment.clearValue.color.float32[0] = target.clear;
        attachments.push_back(attachment);
    }
    auto rendering = vkStruct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    rendering.renderArea = {{0, 0}, {image.width(), image.height()}};
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(attachments.size());
    rendering.pColorAttachments = attachments.data();
    device.fn.vkCmdBeginRendering(context.commands, &rendering);
    context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.points, bindings);
    const VkViewport viewport{0.0F, 0.0F, static_cast<float>(image.width()), static_cast<float>(image.height()),
                              0.0F, 1.0F};
    device.fn.vkCmdSetViewport(context.commands, 0, 1, &viewport);
    device.fn.vkCmdSetScissor(context.commands, 0, 1, &rendering.renderArea);
    device.fn.vkCmdDrawIndirect(context.commands, context.images.near_draw.buffer(), kPointsAt, 1, 0);
    context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.triangles, bindings);
    device.fn.vkCmdDrawIndirect(context.commands, context.images.near_draw.buffer(), 0, 1, 0);
    device.fn.vkCmdEndRendering(context.commands);
}

Result<SplatPipelines> splatPipelines(const Device& device, SplatDesc desc, bool scaled) {
    const std::array<std::uint32_t, 2> point{1, scaled ? 1U : 0U};
    desc.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    desc.constants = point;
    auto points = createSplat(device, desc);
    if (!points) {
        return points.error();
    }
    const std::array<std::uint32_t, 2> triangle{3, scaled ? 1U : 0U};
    desc.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    desc.constants = triangle;
    auto triangles = createSplat(device, desc);
    if (!triangles) {
        return triangles.error();
    }
    return SplatPipelines{std::move(points).value(), std::move(triangles).value()};
}

Result<SplatDepthPass> SplatDepthPass::create(const Device& device, bool ellipsoids) {
    auto pipelines = splatPipelines(
        device,
        {.name = "splat_depth",
         .vertex = ellipsoids ? std::span<const std::uint32_t>(splat_ellipsoid_vert) : splat_vert,
         .fragment = ellipsoids ? std::span<const std::uint32_t>(splat_ellipsoid_depth_frag) : splat_depth_frag,
         .bindings = kDepthBindings,
         .targets = kMetres,
         .blend = VK_BLEND_OP_MIN},
        false);
    if (!pipelines) {
        return pipelines.error();
    }
    constexpr std::array bindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    const std::uint32_t floats = ellipsoids ? kEllipsoidFloats : 3;
    auto near = createCompute(device, {"splat_near", splat_near_comp, bindings, 0, {&floats, 1}});
    if (!near) {
        return near.error();
    }
    return SplatDepthPass{std::move(pipelines).value(), std::move(near).value()};
}

void SplatDepthPass::record(const PassContext& context) const {
    const std::uint64_t count = context.particles.count;
    context.timer.begin(context.commands,
                        {"splat_depth", count, count * (12 + splatBytes(context)) + context.pixels() * 4, true, 3});
    findNear(context, near);
    const std::array bindings{uniform(context.arena.constants()), readBuffer(splatsOf(context))};
    constexpr std::array targets{SplatTarget{PlanImage::DepthA, 1e30F}};
    drawSplats(context, targets, pipelines, bindings);
    context.timer.end(context.commands);
    closeAttachment(context, PlanImage::DepthA);
}

Result<SplatThicknessPass> SplatThicknessPass::create(const Device& device, bool ellipsoids, bool several_looks) {
    const Stages stages = thicknessStages(ellipsoids, several_looks);
    SplatDesc desc{.name = "splat_thickness",
                   .vertex = stages.vertex,
                   .fragment = stages.fragment,
                   .bindings = kThicknessBindings,
                   .targets = kMetres,
                   .blend = VK_BLEND_OP_ADD};
    if (several_looks) {
        desc.bindings = kLooksBindings;
        desc.targets = kMetresAndOptical;
    }
    auto pipelines = splatPipelines(device, desc, true);
    if (!pipelines) {
        return pipelines.error();
    }
    constexpr std::array bindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    auto scene = createCompute(device, {"scene_depth", scene_depth_comp, bindings, 0, {}});
    if (!scene) {
        return scene.error();
    }
    return SplatThicknessPass{std::move(pipelines).value(), std::move(scene).value(), several_looks};
}

void SplatThicknessPass::record(const PassContext& context) const {
    const Image& image = context.images[PlanImage::Thickness];
    const std::uint64_t count = context.particles.count;
    const std::uint64_t texels = std::uint64_t{image.width()} * image.height();
    const std::uint64_t looks_bytes = several_looks ? count * 4 + texels * 16 : 0;
    context.timer.begin(context.commands,
                        {"splat_thickness", count,
                         count * splatBytes(context) + context.pixels() * 4 + texels * 12 + looks_bytes, true, 3});
    const std::array scene_bindings{
        uniform(context.arena.constants()), readBuffer(context.images.thickness_tiles.buffer()),
        sampled(context.targets.host_depth.view), storage(context.images[PlanImage::SceneDepth].view())};
    context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, scene, scene_bindings);
    dispatchTiles(context, context.images.thickness_tiles);
    beforeFragments(context);
    const std::array bindings{uniform(context.arena.constants()), readBuffer(splatsOf(context)),
                              sampled(context.images[PlanImage::SceneDepth].view()),
                              readBuffer(context.particles.fluids)};
    constexpr std::array targets{SplatTarget{PlanImage::Thickness, 0.0F}, SplatTarget{PlanImage::OpticalDepth, 0.0F}};
    drawSplats(context, std::span(targets).first(several_looks ? 2 : 1), pipelines,
               std::span(bindings).first(several_looks ? 4 : 3));
    context.timer.end(context.commands);
    closeAttachment(context, PlanImage::Thickness);
    if (several_looks) {
        closeAttachment(context, PlanImage::OpticalDepth);
    }
}

}  // namespace sluice::vk
