// SPDX-License-Identifier: MIT
#include "live/foam_age.hpp"

#include <shaders/foam_age_comp.h>

#include <algorithm>
#include <array>
#include <utility>

#include "device/commands.hpp"
#include "device/one_shot.hpp"

namespace sluice::vk {
namespace {

constexpr std::uint32_t kGroup = 64;
constexpr std::uint32_t kBindings = 6;

/// Mirrors shaders/foam_age.comp.
struct Push {
    std::uint32_t entries, placed;
    float kept;
};

}  // namespace

Result<std::unique_ptr<FoamAge>> FoamAge::create(const Device& device) {
    auto made = std::make_unique<FoamAge>(device);
    std::array<VkDescriptorType, kBindings> types{};
    types.fill(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    Result<Pipeline> pipeline = createCompute(device, {"foam_age", foam_age_comp, types, sizeof(Push), {}});
    if (!pipeline) {
        return pipeline.error();
    }
    made->pipeline_ = std::move(pipeline).value();
    if (Status status = makeOneSet(device, made->pipeline_, kBindings, made->pool_, made->set_); !status) {
        return status.error();
    }
    return made;
}

FoamAge::~FoamAge() {
    device_.fn.vkDestroyDescriptorPool(device_.handle, pool_, nullptr);
}

Status FoamAge::makeRoom(std::uint32_t identities) {
    const VkDeviceSize needed = VkDeviceSize{std::max(identities, 1U)} * sizeof(float);
    if (needed <= foam_.size()) {
        return {};
    }
    const VkDeviceSize had = foam_.size();
    Result<Buffer> made = Buffer::create(
        device_,
        {std::min<VkDeviceSize>(had > 0 ? 2 * needed : needed, device_.properties.limits.maxStorageBufferRange),
         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
         BufferPlace::Device, "foam by identity"});
    if (!made) {
        return made.error();
    }
    Status filled = runOnce(device_, [&](VkCommandBuffer commands) {
        if (had > 0) {
            const VkBufferCopy whole{0, 0, had};
            device_.fn.vkCmdCopyBuffer(commands, foam_.buffer(), made.value().buffer(), 1, &whole);
        }
        device_.fn.vkCmdFillBuffer(commands, made.value().buffer(), had, VK_WHOLE_SIZE, 0);
    });
    if (filled) {
        foam_ = std::move(made).value();
    }
    return filled;
}

Status FoamAge::age(const DeviceParticles& state, VkBuffer whitewater, const PlaceBuffers& places, float kept) {
    if (state.count == 0) {
        return {};
    }
    // Identities are never used twice: hours of a tap come to more than a buffer may hold, and foam lasts no longer
    // from then on.
    if (VkDeviceSize{state.identities} * sizeof(float) > device_.properties.limits.maxStorageBufferRange) {
        return {};
    }
    if (Status status = makeRoom(state.identities); !status) {
        return status;
    }
    // What is not read has a stand-in.
    const std::array<VkBuffer, kBindings> buffers{state.position,
                                                  state.identity,
                                                  whitewater,
                                                  foam_.buffer(),
                                                  places ? places.marks : state.identity,
                                                  places ? places.before : state.identity};
    writeOneSet(device_, set_, buffers);
    const Push push{state.count, places ? 1U : 0U, kept};
    return runOnce(device_, [&](VkCommandBuffer commands) {
        memoryBarrier(device_, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                      VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
        device_.fn.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.handle);
        device_.fn.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.layout, 0, 1, &set_, 0,
                                           nullptr);
        device_.fn.vkCmdPushConstants(commands, pipeline_.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
        device_.fn.vkCmdDispatch(commands, (state.count + kGroup - 1) / kGroup, 1, 1);
    });
}

}  // namespace sluice::vk
