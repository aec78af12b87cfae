// SPDX-License-Identifier: MIT
#include "device/functions.hpp"

namespace sluice::vk {
namespace {

template <typename Function>
void look(Function& function, VkInstance instance, PFN_vkGetInstanceProcAddr get, const char* name) {
    function = reinterpret_cast<Function>(get(instance, name));
}

}  // namespace

void loadInstanceFunctions(InstanceFunctions& f, VkInstance instance, PFN_vkGetInstanceProcAddr get) {
    look(f.vkDestroyInstance, instance, get, "vkDestroyInstance");
    look(f.vkEnumeratePhysicalDevices, instance, get, "vkEnumeratePhysicalDevices");
    look(f.vkEnumerateDeviceExtensionProperties, instance, get, "vkEnumerateDeviceExtensionProperties");
    look(f.vkGetPhysicalDeviceProperties, instance, get, "vkGetPhysicalDeviceProperties");
    look(f.vkGetPhysicalDeviceProperties2, instance, get, "vkGetPhysicalDeviceProperties2");
    look(f.vkGetPhysicalDeviceFeatures2, instance, get, "vkGetPhysicalDeviceFeatures2");
    look(f.vkGetPhysicalDeviceMemoryProperties, instance, get, "vkGetPhysicalDeviceMemoryProperties");
    look(f.vkGetPhysicalDeviceQueueFamilyProperties, instance, get, "vkGetPhysicalDeviceQueueFamilyProperties");
    look(f.vkGetPhysicalDeviceFormatProperties2, instance, get, "vkGetPhysicalDeviceFormatProperties2");
    look(f.vkGetPhysicalDeviceImageFormatProperties2, instance, get, "vkGetPhysicalDeviceImageFormatProperties2");
    look(f.vkGetPhysicalDeviceExternalSemaphoreProperties, instance, get,
         "vkGetPhysicalDeviceExternalSemaphoreProperties");
    look(f.vkCreateDevice, instance, get, "vkCreateDevice");
    look(f.vkGetPhysicalDeviceCalibrateableTimeDomainsEXT, instance, get,
         "vkGetPhysicalDeviceCalibrateableTimeDomainsEXT");
    look(f.vkCreateDebugUtilsMessengerEXT, instance, get, "vkCreateDebugUtilsMessengerEXT");
    look(f.vkDestroyDebugUtilsMessengerEXT, instance, get, "vkDestroyDebugUtilsMessengerEXT");
    look(f.vkSetDebugUtilsObjectNameEXT, instance, get, "vkSetDebugUtilsObjectNameEXT");
}

}  // namespace sluice::vk
