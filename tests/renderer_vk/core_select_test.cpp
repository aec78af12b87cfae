// SPDX-License-Identifier: MIT
// Choosing the device, on capabilities recorded from real drivers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <volk.h>

#include <cstring>
#include <string>
#include <vector>

#include "device/select.hpp"

namespace sluice::vk {
namespace {

using ::testing::HasSubstr;

DeviceCandidate candidate(const char* name, const char* device_uuid, const char* driver_uuid) {
    DeviceCandidate out;
    SluiceRendererCapabilities& c = out.capabilities;
    c.struct_size = sizeof(c);
    c.api_version = VK_MAKE_API_VERSION(0, 1, 3, 230);
    std::strncpy(c.device_name, name, sizeof(c.device_name) - 1);
    std::memcpy(c.device_uuid, device_uuid, SLUICE_UUID_SIZE);
    std::memcpy(c.driver_uuid, driver_uuid, SLUICE_UUID_SIZE);
    c.has_external_memory_fd = 1;
    c.has_timeline_semaphore = 1;
    out.synchronization2 = out.dynamic_rendering = out.maintenance4 = true;
    out.queue_family = 0;
    return out;
}

// Mesa writes text into its UUIDs and pads with NUL: a string comparison would stop too early.
constexpr char kLavapipe[] = "mesa22.3.6\0\0\0\0\0";
constexpr char kLavapipeBackport[] = "mesa22.3.6\0\0\0\0\1";
constexpr char kLlvmpipeDriver[] = "llvmpipeUUID\0\0\0";
constexpr char kNvidia[] = "\x11\x22\x33\x44\x55\x66\x77\x88\x99\xaa\xbb\xcc\xdd\xee\xff";
constexpr char kNvidiaDriver[] = "\x9f\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0a\x0b\x0c\x0d\x0e";

SluiceHostCapabilities hostWith(std::initializer_list<const char*> devices, const char* driver) {
    SluiceHostCapabilities host{};
    host.struct_size = sizeof(host);
    for (const char* device : devices) {
        std::memcpy(host.device_uuids[host.device_uuid_count++], device, SLUICE_UUID_SIZE);
    }
    std::memcpy(host.driver_uuid, driver, SLUICE_UUID_SIZE);
    return host;
}

TEST(DeviceSelection, TakesTheDeviceOfTheHostAmongSeveral) {
    const std::vector<DeviceCandidate> found{candidate("llvmpipe", kLavapipe, kLlvmpipeDriver),
                                             candidate("NVIDIA H200", kNvidia, kNvidiaDriver)};
    const SluiceHostCapabilities nvidia = hostWith({kNvidia}, kNvidiaDriver);
    const SluiceHostCapabilities llvmpipe = hostWith({kLavapipe}, kLlvmpipeDriver);
    EXPECT_EQ(selectDevice(found, &nvidia).value(), 1U);
    EXPECT_EQ(selectDevice(found, &llvmpipe).value(), 0U);
}

VkQueueFamilyProperties family(VkQueueFlags flags, std::uint32_t queues) {
    VkQueueFamilyProperties out{};
    out.queueFlags = flags;
    out.queueCount = queues;
    return out;
}

TEST(ComputeQueue, IsOneWithoutGraphicsOrASecondOneOrNone) {
    constexpr VkQueueFlags kAll = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT;
    const std::vector<VkQueueFamilyProperties> lavapipe{family(kAll, 1)};
    EXPECT_EQ(chooseComputeQueue(lavapipe, 0), std::nullopt);
    const std::vector<VkQueueFamilyProperties> several{family(kAll, 16)};
    EXPECT_EQ(chooseComputeQueue(several, 0), (QueueChoice{0, 1}));
    const std::vector<VkQueueFamilyProperties> nvidia{family(kAll, 16), family(VK_QUEUE_TRANSFER_BIT, 2),
                                                      family(VK_QUEUE_COMPUTE_BIT, 8)};
    EXPECT_EQ(chooseComputeQueue(nvidia, 0), (QueueChoice{2, 0}));
    EXPECT_EQ(chooseComputeQueue({}, 0), std::nullopt);
}

TEST(DeviceSelection, LooksAtEveryUuidOfTheHost) {
    const std::vector<DeviceCandidate> found{candidate("NVIDIA H200", kNvidia, kNvidiaDriver)};
    const SluiceHostCapabilities host = hostWith({kLavapipe, kNvidia}, kNvidiaDriver);
    EXPECT_TRUE(selectDevice(found, &host));
}

TEST(DeviceSelection, RefusalNamesTheUuidsOfBothSides) {
    const std::vector<DeviceCandidate> found{candidate("llvmpipe", kLavapipe, kLlvmpipeDriver)};
    const SluiceHostCapabilities host = hostWith({kNvidia}, kNvidiaDriver);
    const Result<std::size_t> choice = selectDevice(found, &host);
    ASSERT_FALSE(choice);
    EXPECT_EQ(choice.error().code, SLUICE_ERROR_DEVICE_MISMATCH);
    EXPECT_THAT(choice.error().message(), HasSubstr("11223344-5566-7788-99aa-bbccddeeff00"));
    EXPECT_THAT(choice.error().message(), HasSubstr("6d657361-3232-2e33-2e36-000000000000"));
    EXPECT_LT(choice.error().message().size(), sizeof(SluiceError::message));
}

TEST(DeviceSelection, ComparesBytesBehindTheFirstNul) {
    const std::vector<DeviceCandidate> found{candidate("llvmpipe", kLavapipeBackport, kLlvmpipeDriver)};
    const SluiceHostCapabilities host = hostWith({kLavapipe}, kLlvmpipeDriver);
    EXPECT_FALSE(selectDevice(found, &host));
}

TEST(DeviceSelection, TheDriverMustBeTheSameToo) {
    const std::vector<DeviceCandidate> found{candidate("llvmpipe", kLavapipe, kNvidiaDriver)};
    const SluiceHostCapabilities host = hostWith({kLavapipe}, kLlvmpipeDriver);
    EXPECT_FALSE(selectDevice(found, &host));
}

TEST(DeviceSelection, NamesWhatTheHostsDeviceLacks) {
    struct Case {
        void (*damage)(DeviceCandidate&);
        const char* named;
    };
    const Case cases[] = {
        {[](DeviceCandidate& c) { c.capabilities.api_version = VK_MAKE_API_VERSION(0, 1, 2, 999); }, "Vulkan 1.3"},
        {[](DeviceCandidate& c) { c.capabilities.has_external_memory_fd = 0; }, "VK_KHR_external_memory_fd"},
        {[](DeviceCandidate& c) { c.capabilities.has_timeline_semaphore = 0; }, "timelineSemaphore"},
        {[](DeviceCandidate& c) { c.synchronization2 = false; }, "synchronization2"},
        {[](DeviceCandidate& c) { c.dynamic_rendering = false; }, "dynamicRendering"},
        {[](DeviceCandidate& c) { c.maintenance4 = false; }, "maintenance4"},
        {[](DeviceCandidate& c) { c.queue_family.reset(); }, "queue family"},
    };
    const SluiceHostCapabilities host = hostWith({kNvidia}, kNvidiaDriver);
    for (const Case& test : cases) {
        std::vector<DeviceCandidate> found{candidate("NVIDIA H200", kNvidia, kNvidiaDriver)};
        test.damage(found[0]);
        const Result<std::size_t> choice = selectDevice(found, &host);
        ASSERT_FALSE(choice) << test.named;
        EXPECT_EQ(choice.error().code, SLUICE_ERROR_UNSUPPORTED);
        EXPECT_THAT(choice.error().message(), HasSubstr(test.named));
        EXPECT_THAT(choice.error().message(), HasSubstr("NVIDIA H200"));
    }
}

TEST(DeviceSelection, SaysSoWhenThereIsNoDevice) {
    const SluiceHostCapabilities host = hostWith({kNvidia}, kNvidiaDriver);
    const Result<std::size_t> choice = selectDevice({}, &host);
    ASSERT_FALSE(choice);
    EXPECT_EQ(choice.error().code, SLUICE_ERROR_UNSUPPORTED);
}

TEST(DeviceSelection, OneBitOfDifferenceIsARefusal) {
    EXPECT_TRUE(rc::check("any flipped bit of either UUID refuses", [] {
        const auto bit = *rc::gen::inRange<std::size_t>(0, 8 * SLUICE_UUID_SIZE);
        const auto in_driver = *rc::gen::arbitrary<bool>();
        std::vector<DeviceCandidate> found{candidate("NVIDIA H200", kNvidia, kNvidiaDriver)};
        SluiceHostCapabilities host = hostWith({kNvidia}, kNvidiaDriver);
        RC_ASSERT(selectDevice(found, &host).ok());
        auto& byte = (in_driver ? host.driver_uuid : host.device_uuids[0])[bit / 8];
        byte = static_cast<std::uint8_t>(byte ^ (1U << (bit % 8)));
        RC_ASSERT(!selectDevice(found, &host).ok());
    }));
}

}  // namespace
}  // namespace sluice::vk
