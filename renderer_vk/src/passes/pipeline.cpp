// SPDX-License-Identifier: MIT
#include "passes/pipeline.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "device/structs.hpp"
#include "passes/pipeline_parts.hpp"

namespace sluice::vk {
Status createLayouts(const Device& device, Pipeline& pipeline, std::span<const VkDescriptorType> types,
                     std::uint32_t push_bytes, VkShaderStageFlags stages, const char* name) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (std::uint32_t index = 0; index < types.size(); ++index) {
        bindings.push_back({index, types[index], 1, stages, nullptr});
    }
    auto set = vkStruct<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    set.bindingCount = static_cast<std::uint32_t>(bindings.size());
    set.pBindings = bindings.data();
    if (const VkResult result =
            device.fn.vkCreateDescriptorSetLayout(device.handle, &set, nullptr, &pipeline.set_layout);
        result != VK_SUCCESS) {
        return vulkanError(result, fmt::format("descriptor set layout of {}", name));
    }
    const VkPushConstantRange range{stages, 0, push_bytes};
    auto layout = vkStruct<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &pipeline.set_layout;
    layout.pushConstantRangeCount = push_bytes > 0 ? 1 : 0;
    layout.pPushConstantRanges = &range;
    if (const VkResult result = device.fn.vkCreatePipelineLayout(device.handle, &layout, nullptr, &pipeline.layout);
        result != VK_SUCCESS) {
        return vulkanError(result, fmt::format("pipeline layout of {}", name));
    }
    return {};
}

Pipeline::Pipeline(Pipeline&& other) noexcept {
    *this = std::move(other);
}

Pipeline& Pipeline::operator=(Pipeline&& other) noexcept {
    if (this != &other) {
        reset();
        handle = std::exchange(other.handle, VK_NULL_HANDLE);
        layout = std::exchange(other.layout, VK_NULL_HANDLE);
        set_layout = std::exchange(other.set_layout, VK_NULL_HANDLE);
        device = std::exchange(other.device, nullptr);
    }
    return *this;
}

Pipeline::~Pipeline() {
    reset();
}

void Pipeline::reset() {
    if (device == nullptr) {
        return;
    }
    device->fn.vkDestroyPipeline(device->handle, handle, nullptr);
    device->fn.vkDestroyPipelineLayout(device->handle, layout, nullptr);
    device->fn.vkDestroyDescriptorSetLayout(device->handle, set_layout, nullptr);
    handle = VK_NULL_HANDLE;
    layout = VK_NULL_HANDLE;
    set_layout = VK_NULL_HANDLE;
    device = nullptr;
}

Result<Pipeline> createCompute(const Device& device, const ComputeDesc& desc) {
    Pipeline pipeline;
    pipeline.device = &device;
    if (Status status =
            createLayouts(device, pipeline, desc.bindings, desc.push_bytes, VK_SHADER_STAGE_COMPUTE_BIT, desc.name);
        !status) {
        return status.error();
    }
    const ShaderModule module(device, desc.code);
    if (module.result != VK_SUCCESS) {
        return vulkanError(module.result, fmt::format("shader of {}", desc.name));
    }
    const Specialisation specialisation(desc.constants);
    auto info = vkStruct<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module.handle;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialisation.info;
    info.layout = pipeline.layout;
    if (const VkResult result =
            device.fn.vkCreateComputePipelines(device.handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline.handle);
        result != VK_SUCCESS) {
        return vulkanError(result, fmt::format("compute pipeline {}", desc.name));
    }
    device.name(VK_OBJECT_TYPE_PIPELINE, pipeline.handle, desc.name);
    return pipeline;
}

Result<Pipeline> createSplat(const Device& device, const SplatDesc& desc) {
    Pipeline pipeline;
    pipeline.device = &device;
    if (Status status = createLayouts(device, pipeline, desc.bindings, 0,
                                      VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, desc.name);
        !status) {
        return status.error();
    }
    const ShaderModule vertex(device, desc.vertex);
    const ShaderModule fragment(device, desc.fragment);
    if (vertex.result != VK_SUCCESS || fragment.result != VK_SUCCESS) {
        return vulkanError(vertex.result != VK_SUCCESS ? vertex.result : fragment.result,
                           fmt::format("shaders of {}", desc.name));
    }
    const Specialisation specialisation(desc.constants);
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    for (std::size_t index = 0; index < stages.size(); ++index) {
        stages[index].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stages[index].stage = index == 0 ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
        stages[index].module = index == 0 ? vertex.handle : fragment.handle;
        stages[index].pName = "main";
        stages[index].pSpecializationInfo = &specialisation.info;
    }
    const auto input =
        vkStruct<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    auto assembly =
        vkStruct<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
    assembly.topology = desc.topology;
    auto viewport = vkStruct<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;
    auto raster =
        vkStruct<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
    raster.lineWidth = 1.0F;
    auto samples =
        vkStruct<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.blendEnable = VK_TRUE;
    attachment.srcColorBlendFactor = attachment.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
    attachment.srcAlphaBlendFactor = attachment.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    attachment.colorBlendOp = attachment.alphaBlendOp = desc.blend;
    // Alike for all targets: what differs would ask for the feature independentBlend.
    attachment.colorWriteMask = desc.targets.size() == 1 ? VkColorComponentFlags{VK_COLOR_COMPONENT_R_BIT}
                                                         : VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                                                               VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    const std::vector<VkPipelineColorBlendAttachmentState> attachments(desc.targets.size(), attachment);
    auto blend =
        vkStruct<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
    blend.attachmentCount = static_cast<std::uint32_t>(attachments.size());
    blend.pAttachments = attachments.data();
    const std::array<VkDynamicState, 2> dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    auto dynamic = vkStruct<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
    dynamic.dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size());
    dynamic.pDynamicStates = dynamic_states.data();
    auto rendering = vkStruct<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(desc.targets.size());
    rendering.pColorAttachmentFormats = desc.targets.data();

    auto info = vkStruct<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
    info.pNext = &rendering;
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = pipeline.layout;
    if (const VkResult result =
            device.fn.vkCreateGraphicsPipelines(device.handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline.handle);
        result != VK_SUCCESS) {
        return vulkanError(result, fmt::format("graphics pipeline {}", desc.name));
    }
    device.name(VK_OBJECT_TYPE_PIPELINE, pipeline.handle, desc.name);
    return pipeline;
}

}  // namespace sluice::vk
