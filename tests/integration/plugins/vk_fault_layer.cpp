// SPDX-License-Identifier: MIT
// A Vulkan layer between the renderer and the driver: the Nth call fails as the specification allows it to.
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <array>
#include <cstring>

#include "plugins/vk_faults.hpp"

using sluice::host::test::VkFaults;

#define SLUICE_LAYER_EXPORT __attribute__((visibility("default")))

extern "C" {
SLUICE_LAYER_EXPORT extern VkFaults sluice_vk_faults;
VkFaults sluice_vk_faults;
}

namespace {

enum class Kind { Makes, Submits, Waits };

VkResult fails(Kind kind) {
    VkFaults& faults = sluice_vk_faults;
    if (kind == Kind::Makes) {
        ++faults.made;
        return faults.made == faults.starve_at ? VK_ERROR_OUT_OF_DEVICE_MEMORY : VK_SUCCESS;
    }
    if (kind == Kind::Submits && ++faults.submitted == faults.lose_at) {
        faults.lost = true;
    }
    return faults.lost ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
}

/// One function of the device with its place in the table below.
template <Kind kind, std::size_t index, typename Function>
struct Hook;

std::array<PFN_vkVoidFunction, 32> driver{};

template <Kind kind, std::size_t index, typename... Arguments>
struct Hook<kind, index, VkResult (*)(Arguments...)> {
    static VkResult call(Arguments... arguments) {
        const VkResult failure = fails(kind);
        return failure != VK_SUCCESS ? failure
                                     : reinterpret_cast<VkResult (*)(Arguments...)>(driver[index])(arguments...);
    }
};

struct Entry {
    const char* name;
    PFN_vkVoidFunction function;
};

template <Kind kind, std::size_t index, typename Function>
Entry entry(const char* name) {
    return {name, reinterpret_cast<PFN_vkVoidFunction>(&Hook<kind, index, Function>::call)};
}

const std::array kEntries{
    entry<Kind::Makes, 0, PFN_vkAllocateMemory>("vkAllocateMemory"),
    entry<Kind::Makes, 1, PFN_vkCreateImage>("vkCreateImage"),
    entry<Kind::Makes, 2, PFN_vkCreateImageView>("vkCreateImageView"),
    entry<Kind::Makes, 3, PFN_vkCreateBuffer>("vkCreateBuffer"),
    entry<Kind::Makes, 4, PFN_vkCreateSemaphore>("vkCreateSemaphore"),
    entry<Kind::Makes, 5, PFN_vkCreateFence>("vkCreateFence"),
    entry<Kind::Makes, 6, PFN_vkCreateCommandPool>("vkCreateCommandPool"),
    entry<Kind::Makes, 7, PFN_vkCreateDescriptorPool>("vkCreateDescriptorPool"),
    entry<Kind::Makes, 8, PFN_vkCreateDescriptorSetLayout>("vkCreateDescriptorSetLayout"),
    entry<Kind::Makes, 9, PFN_vkCreatePipelineLayout>("vkCreatePipelineLayout"),
    entry<Kind::Makes, 10, PFN_vkCreateShaderModule>("vkCreateShaderModule"),
    entry<Kind::Makes, 11, PFN_vkCreateGraphicsPipelines>("vkCreateGraphicsPipelines"),
    entry<Kind::Makes, 12, PFN_vkCreateComputePipelines>("vkCreateComputePipelines"),
    entry<Kind::Makes, 13, PFN_vkCreateQueryPool>("vkCreateQueryPool"),
    entry<Kind::Makes, 14, PFN_vkCreateSampler>("vkCreateSampler"),
    entry<Kind::Makes, 15, PFN_vkAllocateCommandBuffers>("vkAllocateCommandBuffers"),
    entry<Kind::Makes, 16, PFN_vkAllocateDescriptorSets>("vkAllocateDescriptorSets"),
    entry<Kind::Makes, 17, PFN_vkMapMemory>("vkMapMemory"),
    entry<Kind::Makes, 18, PFN_vkBindImageMemory>("vkBindImageMemory"),
    entry<Kind::Makes, 19, PFN_vkBindBufferMemory>("vkBindBufferMemory"),
    entry<Kind::Makes, 20, PFN_vkBeginCommandBuffer>("vkBeginCommandBuffer"),
    entry<Kind::Makes, 21, PFN_vkEndCommandBuffer>("vkEndCommandBuffer"),
    entry<Kind::Submits, 22, PFN_vkQueueSubmit>("vkQueueSubmit"),
    entry<Kind::Submits, 23, PFN_vkQueueSubmit2>("vkQueueSubmit2"),
    entry<Kind::Waits, 24, PFN_vkWaitSemaphores>("vkWaitSemaphores"),
    entry<Kind::Waits, 25, PFN_vkWaitForFences>("vkWaitForFences"),
    entry<Kind::Waits, 26, PFN_vkQueueWaitIdle>("vkQueueWaitIdle"),
    entry<Kind::Waits, 27, PFN_vkDeviceWaitIdle>("vkDeviceWaitIdle"),
    entry<Kind::Waits, 28, PFN_vkGetSemaphoreCounterValue>("vkGetSemaphoreCounterValue"),
    entry<Kind::Waits, 29, PFN_vkGetQueryPoolResults>("vkGetQueryPoolResults"),
};
static_assert(kEntries.size() <= driver.size());

PFN_vkGetInstanceProcAddr next_instance_proc = nullptr;
PFN_vkGetDeviceProcAddr next_device_proc = nullptr;
VkInstance the_instance = VK_NULL_HANDLE;

/// The loader's note of who comes next, in the chain of `info`.
template <typename Link, typename Info>
Link* linkOf(const Info* info, VkStructureType type) {
    for (auto* at = static_cast<const VkBaseInStructure*>(info->pNext); at != nullptr; at = at->pNext) {
        // The loader hands its own struct over and expects it to be moved on.
        auto* link = reinterpret_cast<Link*>(const_cast<VkBaseInStructure*>(at));
        if (at->sType == type && link->function == VK_LAYER_LINK_INFO) {
            return link;
        }
    }
    return nullptr;
}

VkResult createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator, VkInstance* out) {
    auto* link = linkOf<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (link == nullptr) {
        return VK_ERROR_INITIALIZATION_FAILED;
    }
    next_instance_proc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(next_instance_proc(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, out);
    the_instance = result == VK_SUCCESS ? *out : VK_NULL_HANDLE;
    return result;
}

VkResult createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info, const VkAllocationCallbacks* allocator,
                      VkDevice* out) {
    auto* link = linkOf<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (link == nullptr) {
        return VK_ERROR_INITIALIZATION_FAILED;
    }
    const PFN_vkGetInstanceProcAddr instance_proc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    next_device_proc = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(instance_proc(the_instance, "vkCreateDevice"));
    const VkResult result = create(physical, info, allocator, out);
    if (result == VK_SUCCESS) {
        sluice_vk_faults.lost = false;
        for (std::size_t i = 0; i < kEntries.size(); ++i) {
            driver[i] = next_device_proc(*out, kEntries[i].name);
        }
    }
    return result;
}

PFN_vkVoidFunction deviceProc(VkDevice device, const char* name) {
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(&deviceProc);
    }
    for (const Entry& one : kEntries) {
        if (std::strcmp(name, one.name) == 0) {
            return one.function;
        }
    }
    return next_device_proc(device, name);
}

PFN_vkVoidFunction instanceProc(VkInstance instance, const char* name) {
    if (std::strcmp(name, "vkGetInstanceProcAddr") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(&instanceProc);
    }
    if (std::strcmp(name, "vkCreateInstance") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(&createInstance);
    }
    if (std::strcmp(name, "vkCreateDevice") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(&createDevice);
    }
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(&deviceProc);
    }
    return instance != VK_NULL_HANDLE && next_instance_proc != nullptr ? next_instance_proc(instance, name) : nullptr;
}

}  // namespace

extern "C" SLUICE_LAYER_EXPORT VkResult vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
    version->loaderLayerInterfaceVersion = 2;
    version->pfnGetInstanceProcAddr = instanceProc;
    version->pfnGetDeviceProcAddr = deviceProc;
    version->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
