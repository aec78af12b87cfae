// SPDX-License-Identifier: MIT
#include "device/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "device/capabilities.hpp"
#include "device/select.hpp"
#include "device/structs.hpp"
#include "device/validation.hpp"

namespace sluice::vk {
namespace {

/// volk keeps the loader's entry points in globals: they are read and written under this lock only, and every device
/// works on its own tables afterwards.
std::mutex& loaderLock() {
    static std::mutex mutex;
    return mutex;
}

std::atomic<bool> no_timer_barrier{false};
std::atomic<bool> stage_uploads{false};
std::atomic<bool> one_queue{false};

Status createInstance(Device& device, bool validation) {
    auto application = vkStruct<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.pApplicationName = "sluice";
    application.pEngineName = "sluice";
    application.apiVersion = VK_API_VERSION_1_3;

    auto info = vkStruct<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo = &application;
    const char* layers[] = {kValidationLayer};
    const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    const VkValidationFeatureEnableEXT enabled[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    auto checks = vkStruct<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
    checks.enabledValidationFeatureCount = 1;
    checks.pEnabledValidationFeatures = enabled;
    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(*device.messages);
    if (validation) {
        if (Status status =
                checkValidationLayer(vkEnumerateInstanceLayerProperties, vkEnumerateInstanceExtensionProperties);
            !status) {
            return status;
        }
        checks.pNext = &messenger;
        info.pNext = &checks;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = layers;
        info.enabledExtensionCount = 2;
        info.ppEnabledExtensionNames = extensions;
    }
    if (const VkResult result = vkCreateInstance(&info, nullptr, &device.instance); result != VK_SUCCESS) {
        Error error = vulkanError(result, "vkCreateInstance");
        error.remedy = "check with vulkaninfo that a Vulkan 1.3 driver is installed";
        if (result == VK_ERROR_INCOMPATIBLE_DRIVER || result == VK_ERROR_LAYER_NOT_PRESENT) {
            error.code = SLUICE_ERROR_UNSUPPORTED;
        }
        return error;
    }
    loadInstanceFunctions(device.instance_fn, device.instance, vkGetInstanceProcAddr);
    if (validation) {
        const VkResult result =
            device.instance_fn.vkCreateDebugUtilsMessengerEXT(device.instance, &messenger, nullptr, &device.messenger);
        if (result != VK_SUCCESS) {
            return vulkanError(result, "vkCreateDebugUtilsMessengerEXT");
        }
    }
    return {};
}

Status choosePhysical(Device& device, const DeviceRequest& request) {
    const InstanceFunctions& fn = device.instance_fn;
    std::uint32_t count = 0;
    VkResult result = fn.vkEnumeratePhysicalDevices(device.instance, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    if (result == VK_SUCCESS && count > 0) {
        result = fn.vkEnumeratePhysicalDevices(device.instance, &count, devices.data());
        devices.resize(count);
    }
    if (result < VK_SUCCESS) {
        return vulkanError(result, "vkEnumeratePhysicalDevices");
    }
    std::vector<DeviceCandidate> candidates;
    candidates.reserve(devices.size());
    for (VkPhysicalDevice physical : devices) {
        candidates.push_back(queryCandidate(fn, physical));
    }
    Result<std::size_t> choice = selectDevice(candidates, request.match_host ? &request.host : nullptr);
    if (!choice) {
        return choice.error();
    }
    device.physical = devices[choice.value()];
    device.capabilities = candidates[choice.value()].capabilities;
    device.driver = candidates[choice.value()].driver;
    device.queue_family = candidates[choice.value()].queue_family.value_or(0);
    fn.vkGetPhysicalDeviceProperties(device.physical, &device.properties);
    fn.vkGetPhysicalDeviceMemoryProperties(device.physical, &device.memory);
    std::uint32_t families = 0;
    fn.vkGetPhysicalDeviceQueueFamilyProperties(device.physical, &families, nullptr);
    std::vector<VkQueueFamilyProperties> properties(families);
    fn.vkGetPhysicalDeviceQueueFamilyProperties(device.physical, &families, properties.data());
    device.timestamp_valid_bits = properties[device.queue_family].timestampValidBits;
    return {};
}

/// Which queues to create; the second, if any, is the one for compute.
struct QueuePlan {
    std::vector<VkDeviceQueueCreateInfo> infos;
    std::optional<QueueChoice> compute;
};

QueuePlan planQueues(const Device& device, const float* priorities) {
    std::uint32_t count = 0;
    device.instance_fn.vkGetPhysicalDeviceQueueFamilyProperties(device.physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    device.instance_fn.vkGetPhysicalDeviceQueueFamilyProperties(device.physical, &count, families.data());
    QueuePlan plan;
    if (!device.switches.one_queue) {
        plan.compute = chooseComputeQueue(families, device.queue_family);
    }
    const auto add = [&](std::uint32_t family, std::uint32_t queues) {
        auto info = vkStruct<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
        info.queueFamilyIndex = family;
        info.queueCount = queues;
        info.pQueuePriorities = priorities;
        plan.infos.push_back(info);
    };
    const bool same_family = plan.compute && plan.compute->family == device.queue_family;
    add(device.queue_family, same_family ? 2 : 1);
    if (plan.compute && !same_family) {
        add(plan.compute->family, 1);
    }
    return plan;
}

/// The device's clock and CLOCK_MONOTONIC can be read together.
bool calibrates(const Device& device) {
    const auto domains = device.instance_fn.vkGetPhysicalDeviceCalibrateableTimeDomainsEXT;
    if (domains == nullptr ||
        !hasExtension(device.instance_fn, device.physical, VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME)) {
        return false;
    }
    std::uint32_t count = 0;
    if (domains(device.physical, &count, nullptr) != VK_SUCCESS) {
        return false;
    }
    std::vector<VkTimeDomainEXT> found(count);
    if (domains(device.physical, &count, found.data()) < VK_SUCCESS) {
        return false;
    }
    const auto has = [&found](VkTimeDomainEXT domain) {
        return std::find(found.begin(), found.end(), domain) != found.end();
    };
    return has(VK_TIME_DOMAIN_DEVICE_EXT) && has(VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT);
}

Status createLogical(Device& device) {
    const InstanceFunctions& fn = device.instance_fn;
    std::vector<const char*> extensions{VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME};
    if (device.capabilities.exports_timeline_fd != 0 || device.capabilities.exports_binary_fd != 0) {
        extensions.push_back(VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME);
    }
    device.features.calibrated_timestamps = calibrates(device);
    if (device.features.calibrated_timestamps) {
        extensions.push_back(VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME);
    }

    auto found12 = vkStruct<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    auto found = vkStruct<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
    found.pNext = &found12;
    fn.vkGetPhysicalDeviceFeatures2(device.physical, &found);

    auto v13 = vkStruct<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
    v13.synchronization2 = VK_TRUE;
    v13.dynamicRendering = VK_TRUE;
    v13.maintenance4 = VK_TRUE;
    auto v12 = vkStruct<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    v12.pNext = &v13;
    v12.timelineSemaphore = VK_TRUE;
    v12.hostQueryReset = found12.hostQueryReset;  // no frame uses it; tests that time passes do
    auto wanted = vkStruct<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
    wanted.pNext = &v12;
    wanted.features.shaderStorageImageWriteWithoutFormat = found.features.shaderStorageImageWriteWithoutFormat;
    wanted.features.largePoints = found.features.largePoints;
    device.features.large_points = wanted.features.largePoints != VK_FALSE;
    device.features.storage_write_without_format = wanted.features.shaderStorageImageWriteWithoutFormat != VK_FALSE;

    constexpr std::array<float, 2> kPriorities{1.0F, 1.0F};
    const QueuePlan queues = planQueues(device, kPriorities.data());
    auto info = vkStruct<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    info.pNext = &wanted;
    info.queueCreateInfoCount = static_cast<std::uint32_t>(queues.infos.size());
    info.pQueueCreateInfos = queues.infos.data();
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    const VkResult result = fn.vkCreateDevice(device.physical, &info, nullptr, &device.handle);
    if (result != VK_SUCCESS) {
        return vulkanError(result, fmt::format("vkCreateDevice on '{}'", device.properties.deviceName));
    }
    // Its own table: nothing else in the process can change where these calls go.
    volkLoadInstanceOnly(device.instance);
    volkLoadDeviceTable(&device.fn, device.handle);
    device.fn.vkGetDeviceQueue(device.handle, device.queue_family, 0, &device.queue);
    if (queues.compute) {
        device.compute_family = queues.compute->family;
        device.fn.vkGetDeviceQueue(device.handle, device.compute_family, queues.compute->index, &device.compute_queue);
    }
    return {};
}

}  // namespace

TestSwitches testSwitches() noexcept {
    return {no_timer_barrier.load(), stage_uploads.load(), one_queue.load()};
}

void setTestSwitches(const TestSwitches& switches) noexcept {
    no_timer_barrier = switches.no_timer_barrier;
    stage_uploads = switches.stage_uploads;
    one_queue = switches.one_queue;
}

Result<std::unique_ptr<Device>> Device::create(const DeviceRequest& request) {
    const std::lock_guard guard(loaderLock());
    if (volkInitialize() != VK_SUCCESS) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "libvulkan.so.1", "the Vulkan loader could not be opened",
                     "install the package libvulkan1"};
    }
    auto device = std::make_unique<Device>();
    device->services = request.services;
    device->messages = std::make_shared<MessageSink>();
    device->messages->services = request.services;
    if (Status status = createInstance(*device, request.validation); !status) {
        return status.error();
    }
    if (Status status = choosePhysical(*device, request); !status) {
        return status.error();
    }
    if (Status status = createLogical(*device); !status) {
        return status.error();
    }
    return device;
}

std::unique_ptr<Device> Device::computeView() const {
    auto out = std::make_unique<Device>();
    out->view = true;
    out->instance = instance;
    out->physical = physical;
    out->handle = handle;
    const bool other = compute_queue != VK_NULL_HANDLE;
    out->queue = other ? compute_queue : queue;
    out->queue_family = other ? compute_family : queue_family;
    out->shared_families = sharingFamilies();
    if (!other) {
        out->queue_use = queue_use;
    }
    out->instance_fn = instance_fn;
    out->fn = fn;
    out->properties = properties;
    out->memory = memory;
    out->driver = driver;
    out->features = features;
    out->switches = switches;
    out->capabilities = capabilities;
    out->services = services;
    out->messages = messages;
    out->messenger = messenger;
    return out;
}

VkResult Device::submit(const VkSubmitInfo2& info, VkFence fence, const HostPromise& promise,
                        HostPromise* behind) const {
    const std::lock_guard guard(queue_use->lock);
    const VkResult result = fn.vkQueueSubmit2(queue, 1, &info, fence);
    if (result == VK_SUCCESS && promise.of) {
        queue_use->behind = promise;
    }
    if (behind != nullptr) {
        *behind = queue_use->behind;
    }
    return result;
}

VkResult Device::waitIdle() const {
    const std::lock_guard guard(queue_use->lock);
    return fn.vkQueueWaitIdle(queue);
}

std::vector<std::uint32_t> Device::sharingFamilies() const {
    if (view) {
        return shared_families;
    }
    if (compute_queue == VK_NULL_HANDLE || compute_family == queue_family) {
        return {};
    }
    return {queue_family, compute_family};
}

Device::~Device() {
    if (view) {
        return;
    }
    if (handle != VK_NULL_HANDLE) {
        fn.vkDeviceWaitIdle(handle);
        fn.vkDestroyDevice(handle, nullptr);
    }
    if (messenger != VK_NULL_HANDLE) {
        instance_fn.vkDestroyDebugUtilsMessengerEXT(instance, messenger, nullptr);
    }
    if (instance != VK_NULL_HANDLE && instance_fn.vkDestroyInstance != nullptr) {
        instance_fn.vkDestroyInstance(instance, nullptr);
    }
}

Result<std::uint32_t> Device::memoryType(std::uint32_t type_bits, VkMemoryPropertyFlags wanted,
                                         VkMemoryPropertyFlags preferred) const {
    for (const VkMemoryPropertyFlags flags : {wanted | preferred, wanted}) {
        for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
            if ((type_bits & (1U << i)) != 0 && (memory.memoryTypes[i].propertyFlags & flags) == flags) {
                return i;
            }
        }
    }
    return Error{SLUICE_ERROR_UNSUPPORTED, properties.deviceName,
                 fmt::format("no memory type of {:#x} has the properties {:#x}", type_bits, wanted), ""};
}

void Device::name(VkObjectType type, std::uint64_t object, const char* text) const {
    if (instance_fn.vkSetDebugUtilsObjectNameEXT == nullptr || messenger == VK_NULL_HANDLE || object == 0) {
        return;
    }
    auto info = vkStruct<VkDebugUtilsObjectNameInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT);
    info.objectType = type;
    info.objectHandle = object;
    info.pObjectName = text;
    instance_fn.vkSetDebugUtilsObjectNameEXT(handle, &info);
}

void Device::log(SluiceLogLevel level, std::string_view message) const {
    logLine(services, level, message);
}

std::uint32_t Device::validationMessages() const {
    return messages->count.load(std::memory_order_relaxed);
}

}  // namespace sluice::vk
