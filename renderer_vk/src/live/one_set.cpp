// SPDX-License-Identifier: MIT
#include "live/one_set.hpp"

#include <algorithm>
#include <vector>

#include "device/structs.hpp"

namespace sluice::vk {

Status makeOneSet(const Device& device, const Pipeline& pipeline, std::size_t bindings, VkDescriptorPool& pool,
                  VkDescriptorSet& set) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, static_cast<std::uint32_t>(bindings)};
    auto desc = vkStruct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    desc.maxSets = 1;
    desc.poolSizeCount = 1;
    desc.pPoolSizes = &size;
    if (const VkResult result = device.fn.vkCreateDescriptorPool(device.handle, &desc, nullptr, &pool);
        result != VK_SUCCESS) {
        return vulkanError(result, "descriptor pool of the output slots");
    }
    auto allocate = vkStruct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &pipeline.set_layout;
    if (const VkResult result = device.fn.vkAllocateDescriptorSets(device.handle, &allocate, &set);
        result != VK_SUCCESS) {
        return vulkanError(result, "descriptor set of the output slots");
    }
    return {};
}

void writeOneSet(const Device& device, VkDescriptorSet set, std::span<const VkBuffer> buffers) {
    std::vector<VkDescriptorBufferInfo> infos(buffers.size());
    std::transform(buffers.begin(), buffers.end(), infos.begin(), [](VkBuffer buffer) {
        return VkDescriptorBufferInfo{buffer, 0, VK_WHOLE_SIZE};
    });
    auto write = vkStruct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set;
    write.descriptorCount = static_cast<std::uint32_t>(infos.size());
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = infos.data();
    device.fn.vkUpdateDescriptorSets(device.handle, 1, &write, 0, nullptr);
}

}  // namespace sluice::vk
