// SPDX-License-Identifier: MIT
#include "stress/vk/kernel.hpp"

#include <shaders/stress_buffer_comp.h>
#include <shaders/stress_colour_frag.h>
#include <shaders/stress_depth_frag.h>
#include <shaders/stress_vert.h>

#include <span>
#include <utility>
#include <vector>

#include "device/structs.hpp"
#include "passes/pipeline_parts.hpp"
#include "stress/chain.hpp"

namespace sluice::stress {
namespace {

using vk::vkStruct;
using vk::vulkanError;

constexpr std::uint32_t kGroup = 64;  ///< local_size_x of stress_buffer.comp
constexpr std::uint32_t kMaxDescriptorSets = 64;
constexpr const char* kName = "stress turn";

/// kCodec and kMask of shaders/common/stress.glsl.
std::array<std::uint32_t, 2> constantsOf(Resource resource) {
    const std::uint32_t codec = resource == Resource::R32F ? 1 : resource == Resource::D32F ? 2 : 0;
    return {codec, wordMask(resource)};
}

}  // namespace

VkFormat formatOf(Resource resource) {
    switch (resource) {
        case Resource::Colour:
            return VK_FORMAT_R8G8B8A8_UNORM;
        case Resource::D32F:
            return VK_FORMAT_D32_SFLOAT;
        case Resource::R32F:
            return VK_FORMAT_R32_SFLOAT;
        case Resource::Buffer:
            break;
    }
    return VK_FORMAT_UNDEFINED;
}

Result<std::unique_ptr<Kernel>> Kernel::create(const vk::Device& device, const Storage& storage) {
    auto kernel = std::make_unique<Kernel>(device);
    kernel->storage_ = storage;
    if (Status status = kernel->createPipeline(); !status) {
        return status.error();
    }
    if (Status status = kernel->createPool(); !status) {
        return status.error();
    }
    return kernel;
}

Kernel::~Kernel() {
    device_.fn.vkDestroyDescriptorPool(device_.handle, pool_, nullptr);
    device_.fn.vkDestroySampler(device_.handle, sampler_, nullptr);
}

Status Kernel::createPool() {
    const VkDescriptorPoolSize size{descriptorType(), bindings() * kMaxDescriptorSets};
    auto pool = vkStruct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool.maxSets = kMaxDescriptorSets;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    VkResult result = device_.fn.vkCreateDescriptorPool(device_.handle, &pool, nullptr, &pool_);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "descriptor pool of the stress test");
    }
    const auto sampler = vkStruct<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);  // nearest; only fetched
    result = device_.fn.vkCreateSampler(device_.handle, &sampler, nullptr, &sampler_);
    return result == VK_SUCCESS ? Status{} : Status{vulkanError(result, "sampler of the stress test")};
}

Status Kernel::createPipeline() {
    const std::vector<VkDescriptorType> types(bindings(), descriptorType());
    const auto constants = constantsOf(storage_.resource);
    if (isBuffer()) {
        auto made = vk::createCompute(device_, {kName, stress_buffer_comp, types, sizeof(TurnConstants), constants});
        if (!made) {
            return made.error();
        }
        pipeline_ = std::move(made).value();
        return {};
    }
    pipeline_.device = &device_;
    Status layouts =
        vk::createLayouts(device_, pipeline_, types, sizeof(TurnConstants), VK_SHADER_STAGE_FRAGMENT_BIT, kName);
    return layouts ? createImagePipeline(constants) : layouts;
}

Status Kernel::createImagePipeline(std::span<const std::uint32_t> constants) {
    const bool depth = storage_.resource == Resource::D32F;
    const VkFormat format = formatOf(storage_.resource);
    const vk::ShaderModule vertex(device_, stress_vert);
    const vk::ShaderModule fragment(device_, depth ? std::span<const std::uint32_t>(stress_depth_frag)
                                                   : std::span<const std::uint32_t>(stress_colour_frag));
    if (vertex.result != VK_SUCCESS || fragment.result != VK_SUCCESS) {
        return vulkanError(vertex.result != VK_SUCCESS ? vertex.result : fragment.result, "shaders of the stress test");
    }
    const vk::Specialisation special(constants);
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    for (std::size_t index = 0; index < stages.size(); ++index) {
        stages.at(index).sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stages.at(index).stage = index == 0 ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
        stages.at(index).module = index == 0 ? vertex.handle : fragment.handle;
        stages.at(index).pName = "main";
        stages.at(index).pSpecializationInfo = index == 0 ? nullptr : &special.info;
    }
    const auto input =
        vkStruct<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    auto assembly =
        vkStruct<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkViewport area{0.0F, 0.0F, static_cast<float>(storage_.width), static_cast<float>(storage_.height),
                          0.0F, 1.0F};
    const VkRect2D scissor{{0, 0}, {storage_.width, storage_.height}};
    auto viewport = vkStruct<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
    viewport.viewportCount = viewport.scissorCount = 1;
    viewport.pViewports = &area;
    viewport.pScissors = &scissor;
    auto raster =
        vkStruct<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
    raster.lineWidth = 1.0F;
    auto samples =
        vkStruct<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    auto depth_state =
        vkStruct<VkPipelineDepthStencilStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
    depth_state.depthTestEnable = depth_state.depthWriteEnable = depth ? VK_TRUE : VK_FALSE;
    depth_state.depthCompareOp = VK_COMPARE_OP_ALWAYS;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    auto blend =
        vkStruct<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
    blend.attachmentCount = depth ? 0 : 1;
    blend.pAttachments = &attachment;
    auto rendering = vkStruct<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    rendering.colorAttachmentCount = depth ? 0 : 1;
    rendering.pColorAttachmentFormats = &format;
    rendering.depthAttachmentFormat = depth ? format : VK_FORMAT_UNDEFINED;

    auto info = vkStruct<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
    info.pNext = &rendering;
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth_state;
    info.pColorBlendState = &blend;
    info.layout = pipeline_.layout;
    const VkResult result =
        device_.fn.vkCreateGraphicsPipelines(device_.handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_.handle);
    return result == VK_SUCCESS ? Status{} : Status{vulkanError(result, "graphics pipeline of the stress test")};
}

Result<VkDescriptorSet> Kernel::setFor(const std::array<SlotRef, kMaxInputs>& inputs, const SlotRef& output) {
    const auto number = [this](const SlotRef& ref) {
        return isBuffer() ? reinterpret_cast<std::uint64_t>(ref.buffer) : reinterpret_cast<std::uint64_t>(ref.view);
    };
    Key key{};
    for (std::size_t j = 0; j < inputs.size(); ++j) {
        key.at(j) = number(inputs.at(j));
    }
    key.back() = isBuffer() ? number(output) : 0;
    if (const auto found = sets_.find(key); found != sets_.end()) {
        return found->second;
    }
    auto allocate = vkStruct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &pipeline_.set_layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    if (const VkResult result = device_.fn.vkAllocateDescriptorSets(device_.handle, &allocate, &set);
        result != VK_SUCCESS) {
        return vulkanError(result, "descriptor set of the stress test");
    }
    for (std::uint32_t binding = 0; binding < bindings(); ++binding) {
        const SlotRef& ref = binding < kMaxInputs ? inputs.at(binding) : output;
        const VkDescriptorImageInfo image{sampler_, ref.view, VK_IMAGE_LAYOUT_GENERAL};
        const VkDescriptorBufferInfo buffer{ref.buffer, 0, VK_WHOLE_SIZE};
        auto write = vkStruct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set;
        write.dstBinding = binding;
        write.descriptorCount = 1;
        write.descriptorType = descriptorType();
        write.pImageInfo = &image;
        write.pBufferInfo = &buffer;
        device_.fn.vkUpdateDescriptorSets(device_.handle, 1, &write, 0, nullptr);
    }
    sets_.emplace(key, set);
    return set;
}

Status Kernel::record(VkCommandBuffer commands, const std::array<SlotRef, kMaxInputs>& inputs, const SlotRef& output,
                      const TurnConstants& constants) {
    Result<VkDescriptorSet> set = setFor(inputs, output);
    if (!set) {
        return set.error();
    }
    const VkPipelineBindPoint point = isBuffer() ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS;
    const VkShaderStageFlags stages = isBuffer() ? VK_SHADER_STAGE_COMPUTE_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
    device_.fn.vkCmdBindPipeline(commands, point, pipeline_.handle);
    device_.fn.vkCmdBindDescriptorSets(commands, point, pipeline_.layout, 0, 1, &set.value(), 0, nullptr);
    device_.fn.vkCmdPushConstants(commands, pipeline_.layout, stages, 0, sizeof(constants), &constants);
    if (isBuffer()) {
        device_.fn.vkCmdDispatch(commands, (constants.texels + kGroup - 1) / kGroup, 1, 1);
        return {};
    }
    const bool depth = storage_.resource == Resource::D32F;
    auto target = vkStruct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    target.imageView = output.view;
    target.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    target.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;  // every texel is written
    target.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    auto rendering = vkStruct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    rendering.renderArea = {{0, 0}, {storage_.width, storage_.height}};
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = depth ? 0 : 1;
    rendering.pColorAttachments = depth ? nullptr : &target;
    rendering.pDepthAttachment = depth ? &target : nullptr;
    device_.fn.vkCmdBeginRendering(commands, &rendering);
    device_.fn.vkCmdDraw(commands, 3, 1, 0, 0);
    device_.fn.vkCmdEndRendering(commands);
    return {};
}

}  // namespace sluice::stress
