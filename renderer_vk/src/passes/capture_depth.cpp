// SPDX-License-Identifier: MIT
#include "passes/capture_depth.hpp"

#include <shaders/capture_depth_comp.h>

#include <algorithm>
#include <array>
#include <utility>

#include "simulation/depth_field.hpp"

namespace sluice::vk {
namespace {

constexpr std::uint32_t kTile = 16;

struct Push {
    DepthHeader header;
    std::array<float, 2> window;
    std::uint32_t scale, linear;
};
static_assert(sizeof(Push) == 112, "std430, and within the 128 bytes that every device has");

DepthView viewOf(const SluiceCamera& camera) {
    DepthView view;
    std::copy_n(&camera.view[0], 16, view.view.begin());
    std::copy_n(&camera.projection[0], 16, view.projection.begin());
    view.near_plane = camera.near_plane;
    return view;
}

}  // namespace

Status checkCamera(const SluiceCamera& camera) {
    Status status = checkDepthView(viewOf(camera));
    if (!status) {
        Error error = status.error();
        error.thing = "frame.camera";
        return error;
    }
    return status;
}

VkDeviceSize captureBytes(std::uint32_t width, std::uint32_t height, std::uint32_t scale) {
    const DepthHeader header = depthHeader({}, width, height, scale, 0.0F);
    return sizeof header + VkDeviceSize{header.size[0]} * header.size[1] * sizeof(float);
}

Result<CaptureDepthPass> CaptureDepthPass::create(const Device& device) {
    constexpr std::array bindings{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    auto pipeline = createCompute(device, {"capture_depth", capture_depth_comp, bindings, sizeof(Push), {}});
    if (!pipeline) {
        return pipeline.error();
    }
    return CaptureDepthPass{std::move(pipeline).value()};
}

void CaptureDepthPass::record(const PassContext& context, const DepthCapture& capture) const {
    const SluiceCamera& camera = context.frame.camera;
    const float(&p)[16] = camera.projection;
    const float s = p[11] != 0.0F ? -p[11] : 1.0F;
    const Push push{
        depthHeader(viewOf(camera), context.plan.width, context.plan.height, capture.scale, capture.thickness),
        {-p[10] / s, p[14] / s},
        capture.scale,
        context.targets.host_depth_encoding == SLUICE_DEPTH_LINEAR ? 1U : 0U};
    const std::uint64_t texels = std::uint64_t{push.header.size[0]} * push.header.size[1];
    context.timer.begin(context.commands,
                        {"capture_depth", context.pixels(), 4 * (context.pixels() + texels), false, 1});
    const std::array bindings{sampled(context.targets.host_depth.view), readBuffer(capture.into)};
    context.arena.bind(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, bindings);
    context.device.fn.vkCmdPushConstants(context.commands, pipeline.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push,
                                         &push);
    dispatchOver(context, push.header.size[0], push.header.size[1], kTile, kTile);
    context.timer.end(context.commands);
}

}  // namespace sluice::vk
