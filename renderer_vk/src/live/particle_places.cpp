// SPDX-License-Identifier: MIT
#include "live/particle_places.hpp"

#include <shaders/places_comp.h>

#include <algorithm>
#include <array>
#include <utility>

#include "device/commands.hpp"
#include "live/one_set.hpp"

namespace sluice::vk {
namespace {

constexpr std::uint32_t kGroup = 64;
/// Words of a block, at least; and blocks, at most: llvmpipe ends a loop silently after 65,535 rounds.
constexpr std::uint32_t kLeastBlock = 64;
constexpr std::uint32_t kMostBlocks = 32'768;
constexpr std::uint32_t kBits = 32;

/// Mirrors shaders/places.comp.
struct Push {
    std::uint32_t turn, entries, words, block;
};
constexpr std::uint32_t kTurns = 4;

std::uint32_t groupsOf(std::uint32_t items, std::uint32_t group) {
    return items / group + (items % group != 0 ? 1 : 0);
}

Result<Buffer> makeWords(const Device& device, std::uint64_t words, const char* name) {
    return Buffer::create(
        device, {words * sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                 BufferPlace::Device, name});
}

}  // namespace

Result<std::unique_ptr<ParticlePlaces>> ParticlePlaces::create(const Device& device) {
    auto made = std::make_unique<ParticlePlaces>(device);
    std::array<VkDescriptorType, 5> types{};
    types.fill(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    Result<Pipeline> pipeline = createCompute(device, {"places", places_comp, types, sizeof(Push), {}});
    if (!pipeline) {
        return pipeline.error();
    }
    made->pipeline_ = std::move(pipeline).value();
    if (Status status = makeOneSet(device, made->pipeline_, types.size(), made->pool_, made->set_); !status) {
        return status.error();
    }
    Result<Buffer> sums = makeWords(device, kMostBlocks, "sums of particles that live");
    if (!sums) {
        return sums.error();
    }
    made->sums_ = std::move(sums).value();
    return made;
}

ParticlePlaces::~ParticlePlaces() {
    device_.fn.vkDestroyDescriptorPool(device_.handle, pool_, nullptr);
}

Status ParticlePlaces::prepare(const DeviceParticles& state) {
    const std::uint64_t words = std::max(groupsOf(state.identities, kBits), 1U);
    if (words * sizeof(std::uint32_t) > marks_.size()) {
        Result<Buffer> marks = makeWords(device_, 2 * words, "particles that live");
        if (!marks) {
            return marks.error();
        }
        Result<Buffer> before = makeWords(device_, 2 * words, "particles before those");
        if (!before) {
            return before.error();
        }
        marks_ = std::move(marks).value();
        before_ = std::move(before).value();
    }
    const std::array<VkBuffer, 5> buffers{state.position, state.identity, marks_.buffer(), before_.buffer(),
                                          sums_.buffer()};
    writeOneSet(device_, set_, buffers);
    return {};
}

void ParticlePlaces::record(VkCommandBuffer commands, const DeviceParticles& state) const {
    const std::uint32_t words = std::max(groupsOf(state.identities, kBits), 1U);
    Push push{0, state.count, words, std::max(kLeastBlock, groupsOf(words, kMostBlocks))};
    const std::uint32_t blocks = groupsOf(words, push.block);
    device_.fn.vkCmdFillBuffer(commands, marks_.buffer(), 0, VkDeviceSize{words} * sizeof(std::uint32_t), 0);
    device_.fn.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.handle);
    device_.fn.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.layout, 0, 1, &set_, 0,
                                       nullptr);
    const std::array<std::uint32_t, kTurns> groups{groupsOf(state.count, kGroup), groupsOf(blocks, kGroup), 1,
                                                   groupsOf(blocks, kGroup)};
    for (push.turn = 0; push.turn < kTurns; ++push.turn) {
        // The fill, or the turn before.
        memoryBarrier(device_, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                      VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
        device_.fn.vkCmdPushConstants(commands, pipeline_.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
        device_.fn.vkCmdDispatch(commands, groups.at(push.turn), 1, 1);
    }
    memoryBarrier(device_, commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
}

}  // namespace sluice::vk
