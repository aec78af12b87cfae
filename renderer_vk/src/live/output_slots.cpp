// SPDX-License-Identifier: MIT
#include "live/output_slots.hpp"

#include <fmt/format.h>
#include <shaders/publish_comp.h>

#include <array>
#include <utility>

#include "device/commands.hpp"
#include "device/one_shot.hpp"
#include "device/structs.hpp"

namespace sluice::vk {
namespace {

constexpr std::uint32_t kGroup = 64;
constexpr std::uint32_t kBindings = 5;

Result<Buffer> makeTriples(const Device& device, std::uint32_t particles, const char* name) {
    const VkDeviceSize bytes = VkDeviceSize{particles} * 3 * sizeof(float);
    if (bytes > device.properties.limits.maxStorageBufferRange) {
        return Error{SLUICE_ERROR_UNSUPPORTED, name,
                     fmt::format("{} particles need a buffer of {} bytes, this device binds at most {}", particles,
                                 bytes, device.properties.limits.maxStorageBufferRange),
                     "simulate fewer particles"};
    }
    return Buffer::create(device, {bytes,
                                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                       VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                   BufferPlace::Device, name, true});
}

}  // namespace

Result<std::unique_ptr<OutputSlots>> OutputSlots::create(const Device& device, std::uint32_t slots,
                                                         std::uint32_t particles, float radius) {
    auto made = std::make_unique<OutputSlots>(device);
    made->particles_ = particles;
    made->radius_ = radius;
    for (std::uint32_t i = 0; i < slots; ++i) {
        Result<Buffer> position = makeTriples(device, particles, "simulated positions");
        if (!position) {
            return position.error();
        }
        Result<Buffer> velocity = makeTriples(device, particles, "simulated velocities");
        if (!velocity) {
            return velocity.error();
        }
        made->slots_.push_back({std::move(position).value(), std::move(velocity).value()});
    }
    // A frame that is told not to wait (a fault of tests) shall read what is defined.
    const Status cleared = runOnce(device, [&](VkCommandBuffer commands) {
        for (const OutputSlot& slot : made->slots_) {
            device.fn.vkCmdFillBuffer(commands, slot.position.buffer(), 0, VK_WHOLE_SIZE, 0);
            device.fn.vkCmdFillBuffer(commands, slot.velocity.buffer(), 0, VK_WHOLE_SIZE, 0);
        }
    });
    if (!cleared) {
        return cleared.error();
    }
    std::array<VkDescriptorType, kBindings> types{};
    types.fill(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    Result<Pipeline> pipeline = createCompute(device, {"publish", publish_comp, types, sizeof(std::uint32_t), {}});
    if (!pipeline) {
        return pipeline.error();
    }
    made->pipeline_ = std::move(pipeline).value();
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kBindings};
    auto pool = vkStruct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    if (const VkResult result = device.fn.vkCreateDescriptorPool(device.handle, &pool, nullptr, &made->pool_);
        result != VK_SUCCESS) {
        return vulkanError(result, "descriptor pool of the output slots");
    }
    auto allocate = vkStruct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = made->pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &made->pipeline_.set_layout;
    if (const VkResult result = device.fn.vkAllocateDescriptorSets(device.handle, &allocate, &made->set_);
        result != VK_SUCCESS) {
        return vulkanError(result, "descriptor set of the output slots");
    }
    return made;
}

OutputSlots::~OutputSlots() {
    device_.fn.vkDestroyDescriptorPool(device_.handle, pool_, nullptr);
}

Status OutputSlots::publish(const DeviceParticles& state, std::uint64_t value,
                            const VkSemaphoreSubmitInfo& signal) const {
    const OutputSlot& to = slot(value);
    const std::array<VkDescriptorBufferInfo, kBindings> buffers{{{state.position, 0, VK_WHOLE_SIZE},
                                                                 {state.velocity, 0, VK_WHOLE_SIZE},
                                                                 {state.identity, 0, VK_WHOLE_SIZE},
                                                                 {to.position.buffer(), 0, VK_WHOLE_SIZE},
                                                                 {to.velocity.buffer(), 0, VK_WHOLE_SIZE}}};
    // The last use of the set has ended: publish waits for it.
    auto write = vkStruct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set_;
    write.descriptorCount = kBindings;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = buffers.data();
    device_.fn.vkUpdateDescriptorSets(device_.handle, 1, &write, 0, nullptr);
    return runOnce(device_,
                   [&](VkCommandBuffer commands) {
                       memoryBarrier(device_, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                     VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                     VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
                       device_.fn.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.handle);
                       device_.fn.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.layout, 0,
                                                          1, &set_, 0, nullptr);
                       device_.fn.vkCmdPushConstants(commands, pipeline_.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                                     sizeof(state.count), &state.count);
                       device_.fn.vkCmdDispatch(commands, (state.count + kGroup - 1) / kGroup, 1, 1);
                   },
                   {&signal, 1});
}

ParticleBuffers OutputSlots::buffers(std::uint64_t value) const {
    return {slot(value).position.buffer(), particles_, radius_};
}

}  // namespace sluice::vk
