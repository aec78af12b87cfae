// SPDX-License-Identifier: MIT
#include "simulation/single_pass.hpp"

#include <fmt/format.h>

#include <utility>

#include "device/structs.hpp"

namespace sluice::vk {

Result<SinglePass> SinglePass::create(const Device& device, const ComputeDesc& desc) {
    SinglePass made;
    made.device_ = &device;
    Result<Pipeline> pipeline = createCompute(device, desc);
    if (!pipeline) {
        return pipeline.error();
    }
    made.pipeline_ = std::move(pipeline).value();
    std::vector<VkDescriptorPoolSize> sizes;
    for (const VkDescriptorType type : desc.bindings) {
        sizes.push_back({type, 1});
    }
    auto pool = vkStruct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool.maxSets = 1;
    pool.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    pool.pPoolSizes = sizes.data();
    if (const VkResult result = device.fn.vkCreateDescriptorPool(device.handle, &pool, nullptr, &made.pool_);
        result != VK_SUCCESS) {
        return vulkanError(result, fmt::format("descriptor pool of {}", desc.name));
    }
    auto allocate = vkStruct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = made.pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &made.pipeline_.set_layout;
    if (const VkResult result = device.fn.vkAllocateDescriptorSets(device.handle, &allocate, &made.set_);
        result != VK_SUCCESS) {
        return vulkanError(result, fmt::format("descriptor set of {}", desc.name));
    }
    return made;
}

SinglePass::SinglePass(SinglePass&& other) noexcept {
    *this = std::move(other);
}

SinglePass& SinglePass::operator=(SinglePass&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(pipeline_, other.pipeline_);
    std::swap(pool_, other.pool_);
    std::swap(set_, other.set_);
    return *this;
}

SinglePass::~SinglePass() {
    if (device_ != nullptr) {
        device_->fn.vkDestroyDescriptorPool(device_->handle, pool_, nullptr);
    }
}

void SinglePass::bind(std::span<const PassBinding> bindings) const {
    for (std::uint32_t number = 0; number < bindings.size(); ++number) {
        const PassBinding& binding = bindings[number];
        const VkDescriptorBufferInfo buffer{binding.buffer, 0, VK_WHOLE_SIZE};
        auto write = vkStruct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set_;
        write.dstBinding = number;
        write.descriptorCount = 1;
        write.descriptorType = binding.type;
        write.pBufferInfo = &buffer;
        write.pTexelBufferView = &binding.texels;
        device_->fn.vkUpdateDescriptorSets(device_->handle, 1, &write, 0, nullptr);
    }
}

void SinglePass::dispatch(VkCommandBuffer commands, std::span<const std::byte> push, std::uint32_t groups) const {
    device_->fn.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.handle);
    device_->fn.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.layout, 0, 1, &set_, 0,
                                        nullptr);
    device_->fn.vkCmdPushConstants(commands, pipeline_.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                   static_cast<std::uint32_t>(push.size()), push.data());
    device_->fn.vkCmdDispatch(commands, groups, 1, 1);
}

Status buildOnce(const Device& device, SinglePass& pass, const ComputeDesc& desc) {
    if (pass) {
        return {};
    }
    Result<SinglePass> made = SinglePass::create(device, desc);
    if (!made) {
        return made.error();
    }
    pass = std::move(made).value();
    return {};
}

}  // namespace sluice::vk
