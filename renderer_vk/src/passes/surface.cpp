// SPDX-License-Identifier: MIT
#include "passes/surface.hpp"

#include <shaders/blur_thickness_comp.h>
#include <shaders/normals_comp.h>

#include <array>
#include <utility>

namespace sluice::vk {
namespace {

Result<Pipeline> blurPipeline(const Device& device, const char* name, std::uint32_t along, bool several_looks) {
    constexpr std::array bindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,  VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                  VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,  VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                  VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    const std::array<std::uint32_t, 2> constants{along, several_looks ? 1U : 0U};
    return createCompute(device, {name, blur_thickness_comp, bindings, 0, constants});
}

}  // namespace

Result<NormalsPass> NormalsPass::create(const Device& device) {
    constexpr std::array bindings{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    auto pipeline = createCompute(device, {"normals", normals_comp, bindings, 0, {}});
    if (!pipeline) {
        return pipeline.error();
    }
    return NormalsPass{std::move(pipeline).value()};
}

void NormalsPass::record(const PassContext& context) const {
    context.timer.begin(context.commands, {"normals", context.pixels(), context.pixels() * (4 + 8), false, 1});
    const Buffer& tiles = context.images.surface_tiles;
    const std::array bindings{uniform(context.arena.constants()), readBuffer(tiles.buffer()),
                              sampled(context.images[context.plan.surface].view()),
                              storage(context.images[PlanImage::Normal].view())};
    context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, bindings);
    dispatchTiles(context, tiles);
    context.timer.end(context.commands);
    betweenDispatches(context);
}

Result<BlurThicknessPass> BlurThicknessPass::create(const Device& device, bool several_looks) {
    auto x = blurPipeline(device, "blur_thickness_x", 0, several_looks);
    if (!x) {
        return x.error();
    }
    auto y = blurPipeline(device, "blur_thickness_y", 1, several_looks);
    if (!y) {
        return y.error();
    }
    return BlurThicknessPass{std::move(x).value(), std::move(y).value(), several_looks};
}

void BlurThicknessPass::record(const PassContext& context) const {
    const Image& image = context.images[PlanImage::Thickness];
    const std::uint64_t texels = std::uint64_t{image.width()} * image.height();
    const PassImages& images = context.images;
    const auto step = [&](const Pipeline& pipeline, std::array<PlanImage, 2> from, std::array<PlanImage, 2> to) {
        const Buffer& tiles = context.images.thickness_tiles;
        const std::array bindings{uniform(context.arena.constants()),
                                  readBuffer(tiles.buffer()),
                                  sampled(images[from[0]].view()),
                                  sampled(images[context.plan.surface].view()),
                                  storage(images[to[0]].view()),
                                  sampled(several_looks ? images[from[1]].view() : images.nothing_to_read.view()),
                                  storage(several_looks ? images[to[1]].view() : images.nothing_to_write.view())};
        context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, bindings);
        dispatchTiles(context, tiles);
        betweenDispatches(context);
    };
    const std::uint64_t bytes = 4 + 8 + 8 + 4 + (several_looks ? 4 * 16 : 0);
    context.timer.begin(context.commands, {"blur_thickness", texels, texels * bytes, false, 2});
    step(along_x, {PlanImage::Thickness, PlanImage::OpticalDepth}, {PlanImage::ThicknessSums, PlanImage::OpticalSums});
    step(along_y, {PlanImage::ThicknessSums, PlanImage::OpticalSums}, {PlanImage::Thickness, PlanImage::OpticalDepth});
    context.timer.end(context.commands);
}

}  // namespace sluice::vk
