// SPDX-License-Identifier: MIT
#include "passes/fluid_recorder.hpp"

#include <array>
#include <cassert>
#include <optional>
#include <utility>
#include <vector>

#include "device/one_shot.hpp"
#include "passes/context.hpp"
#include "passes/echo.hpp"
#include "passes/frame_constants.hpp"
#include "sluice/format.hpp"

namespace sluice::vk {

struct FluidRecorder::State {
    explicit State(const Device& owner) : device(owner) {}

    const Device& device;
    std::vector<FrameArena> arenas;
    PassImages images;
    EchoPass echo;
    ClearPass clear;
    std::optional<Plan> plan;
};

namespace {

/// Moves the value out of a Result or hands its error on.
template <typename T>
Status take(Result<T> result, T& into) {
    if (!result) {
        return result.error();
    }
    into = std::move(result).value();
    return {};
}

Result<Image> makePlaceholder(const Device& device) {
    auto image = Image::create(device, {VK_FORMAT_R16G16B16A16_SFLOAT, 1, 1,
                                        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT, false, "placeholder"});
    if (!image) {
        return image;
    }
    const Status status = runOnce(device, [&](VkCommandBuffer commands) {
        fullBarrier(device, commands, image.value().image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                    VK_IMAGE_LAYOUT_GENERAL);
    });
    if (!status) {
        return status.error();
    }
    return image;
}

}  // namespace

FluidRecorder::FluidRecorder(std::unique_ptr<State> state) : state_(std::move(state)) {}
FluidRecorder::FluidRecorder(FluidRecorder&& other) noexcept = default;
FluidRecorder& FluidRecorder::operator=(FluidRecorder&& other) noexcept = default;
FluidRecorder::~FluidRecorder() = default;

Result<FluidRecorder> FluidRecorder::create(const Device& device) {
    if (!device.features.storage_write_without_format) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "shaderStorageImageWriteWithoutFormat",
                     "this device cannot write the shared images from one shader", "use another Vulkan device"};
    }
    auto state = std::make_unique<State>(device);
    for (std::uint32_t slot = 0; slot < SLUICE_MAX_IMAGE_SETS; ++slot) {
        auto arena = FrameArena::create(device, sizeof(FrameConstants));
        if (!arena) {
            return arena.error();
        }
        state->arenas.push_back(std::move(arena).value());
    }
    for (const Status& status : {take(makePlaceholder(device), state->images.nothing_to_read),
                                 take(makePlaceholder(device), state->images.nothing_to_write),
                                 take(EchoPass::create(device), state->echo),
                                 take(ClearPass::create(device), state->clear)}) {
        if (!status) {
            return status.error();
        }
    }
    return FluidRecorder(std::move(state));
}

Status FluidRecorder::prepare(const Plan& plan) {
    state_->plan = plan;
    return {};
}

Status FluidRecorder::setEnvironment(const SluiceEnvironment* /*environment*/) { return {}; }

void FluidRecorder::record(VkCommandBuffer commands, const SluiceFrame& frame, const Plan& plan,
                           const FrameTargets& targets, const ParticleBuffers& particles, PassTimer& timer) {
    assert(state_->plan && *state_->plan == plan);
    FrameArena& arena = state_->arenas.at(frame.image_set);
    const FrameConstants constants = makeFrameConstants(frame, plan, targets, particles);
    arena.begin(std::as_bytes(std::span(&constants, 1)));
    const PassContext context{state_->device, commands, frame, plan, targets, particles, timer, arena, state_->images};
    openImages(context);
    for (const PlannedPass& pass : plan.passes) {
        switch (pass.id) {
            case PassId::Echo:
                state_->echo.record(context);
                break;
            case PassId::Clear:
                state_->clear.record(context);
                break;
            default:
                break;
        }
    }
}

}  // namespace sluice::vk
