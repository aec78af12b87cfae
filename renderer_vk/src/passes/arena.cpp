// SPDX-License-Identifier: MIT
#include "passes/arena.hpp"

#include <array>
#include <cassert>
#include <cstring>
#include <utility>

#include "device/structs.hpp"
#include "plan/plan.hpp"

namespace sluice::vk {
namespace {

constexpr std::uint32_t kMaxBindings = 16;
/// Every pass takes one set per dispatch; the filter takes the most.
constexpr std::uint32_t kMaxSets = 2 * kMaxFilterIterations + 16;

}  // namespace

Result<FrameArena> FrameArena::create(const Device& device, std::size_t constants_bytes) {
    FrameArena arena;
    arena.device_ = &device;
    const std::array<VkDescriptorPoolSize, 4> sizes{{{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 4 * kMaxSets},
                                                     {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 4 * kMaxSets},
                                                     {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kMaxSets},
                                                     {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2 * kMaxSets}}};
    auto info = vkStruct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    info.maxSets = kMaxSets;
    info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    info.pPoolSizes = sizes.data();
    if (const VkResult result = device.fn.vkCreateDescriptorPool(device.handle, &info, nullptr, &arena.pool_);
        result != VK_SUCCESS) {
        return vulkanError(result, "descriptor pool of an image set");
    }
    auto buffer = Buffer::create(
        device, {constants_bytes, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, BufferPlace::Upload, "frame constants"});
    if (!buffer) {
        return buffer.error();
    }
    arena.constants_ = std::move(buffer).value();
    return arena;
}

FrameArena::FrameArena(FrameArena&& other) noexcept {
    *this = std::move(other);
}

FrameArena& FrameArena::operator=(FrameArena&& other) noexcept {
    if (this != &other) {
        reset();
        device_ = std::exchange(other.device_, nullptr);
        pool_ = std::exchange(other.pool_, VK_NULL_HANDLE);
        constants_ = std::move(other.constants_);
    }
    return *this;
}

FrameArena::~FrameArena() {
    reset();
}

void FrameArena::reset() {
    if (device_ != nullptr) {
        device_->fn.vkDestroyDescriptorPool(device_->handle, pool_, nullptr);
        pool_ = VK_NULL_HANDLE;
        device_ = nullptr;
    }
}

void FrameArena::begin(std::span<const std::byte> constants) {
    assert(constants.size() <= constants_.mapped().size());
    std::memcpy(constants_.mapped().data(), constants.data(), constants.size());
    device_->fn.vkResetDescriptorPool(device_->handle, pool_, 0);
    failure_ = VK_SUCCESS;
}

void FrameArena::bind(VkCommandBuffer commands, VkPipelineBindPoint point, const Pipeline& pipeline,
                      std::span<const Binding> bindings) {
    assert(bindings.size() <= kMaxBindings);
    auto allocate = vkStruct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &pipeline.set_layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    const VkResult result = device_->fn.vkAllocateDescriptorSets(device_->handle, &allocate, &set);
    device_->fn.vkCmdBindPipeline(commands, point, pipeline.handle);
    // The pool is sized for every plan that makePlan can return; memory may still run out.
    if (result != VK_SUCCESS) {
        failure_ = failure_ == VK_SUCCESS ? result : failure_;
        return;
    }
    std::array<VkDescriptorImageInfo, kMaxBindings> images{};
    std::array<VkDescriptorBufferInfo, kMaxBindings> buffers{};
    std::array<VkWriteDescriptorSet, kMaxBindings> writes{};
    for (std::size_t index = 0; index < bindings.size(); ++index) {
        const Binding& binding = bindings[index];
        images[index] = {VK_NULL_HANDLE, binding.view, VK_IMAGE_LAYOUT_GENERAL};
        buffers[index] = {binding.buffer, 0, VK_WHOLE_SIZE};
        writes[index].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        writes[index].dstSet = set;
        writes[index].dstBinding = static_cast<std::uint32_t>(index);
        writes[index].descriptorCount = 1;
        writes[index].descriptorType = binding.type;
        writes[index].pImageInfo = &images[index];
        writes[index].pBufferInfo = &buffers[index];
    }
    device_->fn.vkUpdateDescriptorSets(device_->handle, static_cast<std::uint32_t>(bindings.size()), writes.data(), 0,
                                       nullptr);
    device_->fn.vkCmdBindDescriptorSets(commands, point, pipeline.layout, 0, 1, &set, 0, nullptr);
}

}  // namespace sluice::vk
