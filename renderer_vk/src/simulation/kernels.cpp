// SPDX-License-Identifier: MIT
#include "simulation/kernels.hpp"

#include <shaders/simulation_born_comp.h>
#include <shaders/simulation_curl_comp.h>
#include <shaders/simulation_delta_comp.h>
#include <shaders/simulation_depth_comp.h>
#include <shaders/simulation_finish_comp.h>
#include <shaders/simulation_lambda_comp.h>
#include <shaders/simulation_neighbours_comp.h>
#include <shaders/simulation_order_comp.h>
#include <shaders/simulation_predict_comp.h>
#include <shaders/simulation_retire_comp.h>
#include <shaders/simulation_scan_blocks_comp.h>
#include <shaders/simulation_scan_cells_comp.h>
#include <shaders/simulation_scan_sums_comp.h>
#include <shaders/simulation_scatter_comp.h>
#include <shaders/simulation_surface_comp.h>
#include <shaders/simulation_velocity_comp.h>

#include <span>
#include <utility>

#include "device/structs.hpp"

namespace sluice::vk {
namespace {

struct Use {
    Slot slot;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
};
constexpr Use uniform(Slot slot) {
    return {slot, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER};
}
constexpr Use texels(Slot slot) {
    return {slot, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER};
}

/// Bindings 1 and up; binding 0 is the parameters.
struct KernelDesc {
    Kernel kernel;
    std::span<const std::uint32_t> code;
    std::vector<Use> uses;
    std::vector<std::uint32_t> constants{};
};

std::vector<KernelDesc> descriptions(const Features& features) {
    using enum Slot;
    const std::vector<Use> lambda{texels(Sorted), texels(List), {ListCount}, {Pushed}, {Walls}, {Meshes}};
    const std::uint32_t bodies = features.bodies ? 1 : 0;
    const std::uint32_t meshes = features.meshes ? 1 : 0;
    const std::uint32_t seen = features.seen ? 1 : 0;
    const std::uint32_t fluids = features.fluids ? 1 : 0;
    const auto density = static_cast<std::uint32_t>(features.density);
    const std::vector<Use> finish{texels(Sorted), texels(Moving), texels(Curl),  texels(List), {ListCount},
                                  {Before},       {PositionOut},  {VelocityOut}, {Status},     uniform(Bodies),
                                  {Pushes},       texels(Walls),  {Meshes},      {Seen}};
    return {
        {Kernel::Predict,
         simulation_predict_comp,
         {{PositionIn},
          {VelocityIn},
          {Predicted},
          {Arrival},
          {Cells},
          {Status},
          uniform(Sources),
          uniform(Bodies),
          {Pushes},
          {Meshes},
          {Seen}},
         {features.fields ? 1U : 0U, bodies, 0, meshes, seen, fluids}},
        {Kernel::ScanSums, simulation_scan_sums_comp, {{Cells}, {Sums}}},
        {Kernel::ScanBlocks, simulation_scan_blocks_comp, {{Sums}}},
        {Kernel::ScanCells, simulation_scan_cells_comp, {{Cells}, {Sums}}},
        {Kernel::Depth, simulation_depth_comp, {{Cells}, {Status}}, {features.depth_axis}},
        {Kernel::Scatter, simulation_scatter_comp, {{Arrival}, {Cells}, {IdentityIn}, {Bucket}}},
        {Kernel::Order,
         simulation_order_comp,
         {{Arrival},
          {Cells},
          {IdentityIn},
          {Bucket},
          {PositionIn},
          {Predicted},
          {Sorted},
          {Before},
          {IdentityOut},
          {Status},
          {Seen}},
         {0, 0, 0, 0, seen, fluids}},
        {Kernel::Neighbours,
         simulation_neighbours_comp,
         {texels(Sorted), texels(Cells), {List, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER}, {ListCount}, {Status}}},
        {Kernel::Lambda, simulation_lambda_comp, lambda, {0, 0, 0, meshes, seen, fluids, density}},
        {Kernel::Measure, simulation_lambda_comp, lambda, {1, 0, 0, meshes, seen, fluids, density}},
        {Kernel::Delta,
         simulation_delta_comp,
         {texels(Pushed),
          texels(List),
          {ListCount},
          {Walls},
          {Sorted},
          uniform(Bodies),
          {Pushes},
          {Meshes},
          {Seen},
          {Before}},
         {0, bodies, 0, meshes, seen, fluids, density}},
        {Kernel::Velocity, simulation_velocity_comp, {{Sorted}, {Before}, {Moving}}},
        {Kernel::Curl, simulation_curl_comp, {texels(Sorted), texels(Moving), texels(List), {ListCount}, {Slot::Curl}}},
        {Kernel::Surface,
         simulation_surface_comp,
         {texels(Sorted), texels(List), {ListCount}, {Slot::Walls}, {Meshes}},
         {0, 0, 0, meshes, seen}},
        {Kernel::Finish,
         simulation_finish_comp,
         finish,
         {features.confined ? 1U : 0U, bodies, features.tension ? 1U : 0U, meshes, seen, fluids}},
        {Kernel::Retire, simulation_retire_comp, {uniform(Sources), {Births}, {Blocked}, {PositionOut}, {Status}}},
        {Kernel::Born,
         simulation_born_comp,
         {{Births}, {Blocked}, {PositionOut}, {VelocityOut}, {IdentityOut}, {Status}}},
    };
}

/// The buffer that a slot means when In and Out have changed places.
Slot exchanged(Slot slot) {
    switch (slot) {
        case Slot::PositionIn:
            return Slot::PositionOut;
        case Slot::PositionOut:
            return Slot::PositionIn;
        case Slot::VelocityIn:
            return Slot::VelocityOut;
        case Slot::VelocityOut:
            return Slot::VelocityIn;
        case Slot::IdentityIn:
            return Slot::IdentityOut;
        case Slot::IdentityOut:
            return Slot::IdentityIn;
        default:
            return slot;
    }
}

constexpr std::array<const char*, kKernels> kNames{
    "predict", "scan_sums", "scan_blocks", "scan_cells", "depth",   "scatter", "order",  "neighbours", "lambda",
    "measure", "delta",     "velocity",    "curl",       "surface", "finish",  "retire", "born"};

void write(const Device& device, VkDescriptorSet set, std::uint32_t binding, Use use, const SimulationBuffers& buffers,
           const Buffer& meshes, VkBuffer seen) {
    const bool own = use.slot == Slot::Meshes || use.slot == Slot::Seen;
    const VkBuffer other = use.slot == Slot::Seen ? seen : meshes.buffer();
    const VkDescriptorBufferInfo buffer{own ? other : buffers[use.slot].buffer(), 0, VK_WHOLE_SIZE};
    auto info = vkStruct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    info.dstSet = set;
    info.dstBinding = binding;
    info.descriptorCount = 1;
    info.descriptorType = use.type;
    info.pBufferInfo = &buffer;
    if (!own) {
        info.pTexelBufferView = &buffers.texels.at(static_cast<std::size_t>(use.slot)).handle;
    }
    device.fn.vkUpdateDescriptorSets(device.handle, 1, &info, 0, nullptr);
}

}  // namespace

const char* kernelName(Kernel kernel) {
    return kNames.at(static_cast<std::size_t>(kernel));
}

Result<Kernels> Kernels::create(const Device& device, const Features& features) {
    Kernels made;
    made.device_ = &device;
    made.features_ = features;
    constexpr auto kSets = static_cast<std::uint32_t>(2 * kKernels);
    constexpr std::array<VkDescriptorPoolSize, 4> kSizes{{{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 3 * kSets},
                                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 12 * kSets},
                                                          {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 5 * kSets},
                                                          {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, kSets}}};
    auto pool = vkStruct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool.maxSets = kSets;
    pool.poolSizeCount = static_cast<std::uint32_t>(kSizes.size());
    pool.pPoolSizes = kSizes.data();
    if (const VkResult result = device.fn.vkCreateDescriptorPool(device.handle, &pool, nullptr, &made.pool_);
        result != VK_SUCCESS) {
        return vulkanError(result, "descriptor pool of the simulation");
    }
    for (const KernelDesc& desc : descriptions(features)) {
        std::vector<VkDescriptorType> types{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER};
        for (const Use& use : desc.uses) {
            types.push_back(use.type);
        }
        Result<Pipeline> pipeline =
            createCompute(device, {kernelName(desc.kernel), desc.code, types, 0, desc.constants});
        if (!pipeline) {
            return pipeline.error();
        }
        const auto index = static_cast<std::size_t>(desc.kernel);
        made.pipelines_.at(index) = std::move(pipeline).value();
        const std::array<VkDescriptorSetLayout, 2> layouts{made.pipelines_.at(index).set_layout,
                                                           made.pipelines_.at(index).set_layout};
        auto allocate = vkStruct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
        allocate.descriptorPool = made.pool_;
        allocate.descriptorSetCount = static_cast<std::uint32_t>(layouts.size());
        allocate.pSetLayouts = layouts.data();
        if (const VkResult result =
                device.fn.vkAllocateDescriptorSets(device.handle, &allocate, made.sets_.at(index).data());
            result != VK_SUCCESS) {
            return vulkanError(result, "descriptor sets of the simulation");
        }
    }
    return made;
}

Kernels::Kernels(Kernels&& other) noexcept {
    *this = std::move(other);
}

Kernels& Kernels::operator=(Kernels&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(features_, other.features_);
    std::swap(pool_, other.pool_);
    std::swap(pipelines_, other.pipelines_);
    std::swap(sets_, other.sets_);
    return *this;
}

Kernels::~Kernels() {
    if (device_ != nullptr) {
        device_->fn.vkDestroyDescriptorPool(device_->handle, pool_, nullptr);
    }
}

void Kernels::bind(const SimulationBuffers& buffers, const Buffer& meshes, VkBuffer seen) const {
    for (const KernelDesc& desc : descriptions(features_)) {
        for (std::size_t odd = 0; odd < 2; ++odd) {
            const VkDescriptorSet set = sets_.at(static_cast<std::size_t>(desc.kernel)).at(odd);
            write(*device_, set, 0, {Slot::Parameters, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, buffers, meshes, seen);
            for (std::uint32_t i = 0; i < desc.uses.size(); ++i) {
                const Use use = desc.uses[i];
                write(*device_, set, i + 1, odd == 1 ? Use{exchanged(use.slot), use.type} : use, buffers, meshes, seen);
            }
        }
    }
}

void Kernels::dispatch(VkCommandBuffer commands, Kernel kernel, bool odd, std::uint32_t groups) const {
    const auto index = static_cast<std::size_t>(kernel);
    const Pipeline& pipeline = pipelines_.at(index);
    device_->fn.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle);
    device_->fn.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1,
                                        &sets_.at(index).at(odd ? 1 : 0), 0, nullptr);
    device_->fn.vkCmdDispatch(commands, groups, 1, 1);
}

}  // namespace sluice::vk
