// SPDX-License-Identifier: MIT
// One Vulkan device and the queue that work on it goes to: the renderer's root object. Everything else refers to it and
// dies before it.
#pragma once

#include <volk.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include "device/functions.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "sync/host_promises.hpp"

namespace sluice::vk {

struct MessageSink;

/// Paths that this device would not take by itself, so that tests can see them. Not part of the ABI.
struct TestSwitches {
    bool no_timer_barrier = false;  ///< FrameTimer leaves its barrier out, whatever the driver
    bool stage_uploads = false;     ///< particles go through a staging buffer, whatever the memory
    bool one_queue = false;         ///< the simulation takes turns with the frames, whatever queues there are
};

/// The switches of devices created from now on, by any thread; all off unless a test, which links this core and not the
/// plugin, has set them.
[[nodiscard]] TestSwitches testSwitches() noexcept;
void setTestSwitches(const TestSwitches& switches) noexcept;

/// What the device must be and who hears of it.
struct DeviceRequest {
    SluiceHostCapabilities host{};  ///< UUIDs to match
    bool match_host = true;         ///< false: take the first device that can run frames, for what shares nothing
    bool validation = false;        ///< the Khronos layer with synchronisation validation
    const SluiceHostServices* services = nullptr;  ///< log; may be null; must outlive the device
};

/// Optional features that were found and enabled.
struct DeviceFeatures {
    bool storage_write_without_format = false;
    bool large_points = false;           ///< points of more than one pixel
    bool calibrated_timestamps = false;  ///< device and CLOCK_MONOTONIC
};

/// Of one queue.
struct QueueUse {
    std::mutex lock;
    HostPromise behind;  ///< what its last submission that waited for the host waits for
};

/// Owns the instance and the device. Pinned in memory: keep it by unique_ptr and pass `const Device&`. Call device
/// functions through `fn`: `device.fn.vkCmdDispatch(commands, x, y, z)`; from any thread within Vulkan's own rules, but
/// what uses a queue goes through submit() and waitIdle(). Enabled always: Vulkan 1.3 with synchronization2,
/// dynamicRendering, maintenance4, timelineSemaphore.
struct Device {
    static Result<std::unique_ptr<Device>> create(const DeviceRequest& request);
    /// The same device as work on its compute queue sees it: another `queue`, or the same one where there is no other,
    /// and nothing owned. Takes no timestamps (lavapipe's results wait until every queue is idle). Dies before this
    /// one.
    [[nodiscard]] std::unique_ptr<Device> computeView() const;

    Device() = default;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    /// Waits until the device is idle. Every object made from it must be gone.
    ~Device();

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice handle = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;  ///< graphics and compute; of computeView(): for compute
    std::uint32_t queue_family = 0;
    std::shared_ptr<QueueUse> queue_use = std::make_shared<QueueUse>();  ///< of `queue`
    VkQueue compute_queue = VK_NULL_HANDLE;  ///< runs beside `queue`; null where the device has none
    std::uint32_t compute_family = 0;
    std::uint32_t timestamp_valid_bits = 0;  ///< of the queue family; 0: no timestamps

    InstanceFunctions instance_fn{};
    VolkDeviceTable fn{};

    VkPhysicalDeviceProperties properties{};
    VkPhysicalDeviceMemoryProperties memory{};
    VkDriverId driver{};
    DeviceFeatures features{};
    TestSwitches switches = testSwitches();  ///< as they were when the device was created
    SluiceRendererCapabilities capabilities{};

    /// vkQueueSubmit2 and vkQueueWaitIdle, from any thread: a queue may be another thread's as well. `promise`: what
    /// the submission waits for; `behind`: becomes the last such promise of the queue, this one's included.
    [[nodiscard]] VkResult submit(const VkSubmitInfo2& info, VkFence fence, const HostPromise& promise = {},
                                  HostPromise* behind = nullptr) const;
    [[nodiscard]] VkResult waitIdle() const;
    /// The families of both queues where they differ, for buffers that both use; else empty. Of a view: the same.
    [[nodiscard]] std::vector<std::uint32_t> sharingFamilies() const;

    /// Index of a memory type of `type_bits` with all of `wanted`, preferring one that also has all of `preferred`.
    [[nodiscard]] Result<std::uint32_t> memoryType(std::uint32_t type_bits, VkMemoryPropertyFlags wanted,
                                                   VkMemoryPropertyFlags preferred = 0) const;

    /// Names an object for validation messages and captures; free when VK_EXT_debug_utils is off.
    void name(VkObjectType type, std::uint64_t object, const char* text) const;
    template <typename Handle>
    void name(VkObjectType type, Handle object, const char* text) const {
        name(type, reinterpret_cast<std::uint64_t>(object), text);
    }

    /// One line to the host's log, from any thread.
    void log(SluiceLogLevel level, std::string_view message) const;

    /// Warnings and errors of the validation layer since creation; 0 when validation is off.
    [[nodiscard]] std::uint32_t validationMessages() const;

    /// Bytes of exportable images that the CPU has moved through uploadImage and downloadImage. Frames must not add to
    /// it.
    mutable std::atomic<std::uint64_t> shared_bytes_by_cpu{0};

    const SluiceHostServices* services = nullptr;
    std::shared_ptr<MessageSink> messages;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    bool view = false;                           ///< of computeView(): owns nothing
    std::vector<std::uint32_t> shared_families;  ///< of a view, which knows one queue only
};

/// The name of a VkResult, "VK_ERROR_DEVICE_LOST".
[[nodiscard]] std::string_view resultName(VkResult result);

/// A failed call as an Error: DEVICE_LOST, OUT_OF_MEMORY or INTERNAL by `result`. `thing` names the call and its
/// object.
[[nodiscard]] Error vulkanError(VkResult result, std::string_view thing);

}  // namespace sluice::vk
