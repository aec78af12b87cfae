// SPDX-License-Identifier: MIT
#include "driver_fixtures.hpp"

#include <algorithm>
#include <array>

namespace sluice::test {

namespace {

using Uuid = std::array<std::uint8_t, SLUICE_UUID_SIZE>;

constexpr std::uint32_t bit(SluiceFormat format) {
    return 1U << static_cast<std::uint32_t>(format);
}

/// VK_MAKE_API_VERSION(0, 1, minor, patch)
constexpr std::uint32_t vulkan1(std::uint32_t minor, std::uint32_t patch) {
    return 1U << 22U | minor << 12U | patch;
}

template <std::size_t Size>
void copyText(char (&field)[Size], std::string_view text) {
    std::ranges::copy(text.substr(0, Size - 1), field);
}

void setGlIdentity(DriverPair& pair, const Uuid& device, const Uuid& driver) {
    pair.gl.device_uuid_count = 1;
    std::ranges::copy(device, pair.gl.device_uuids[0]);
    std::ranges::copy(driver, pair.gl.driver_uuid);
}

void setVkIdentity(DriverPair& pair, const Uuid& device, const Uuid& driver) {
    std::ranges::copy(device, pair.vk.device_uuid);
    std::ranges::copy(driver, pair.vk.driver_uuid);
}

DriverPair named(std::string_view name, std::string_view source) {
    DriverPair pair{name, source, {}, {}};
    pair.gl.struct_size = sizeof pair.gl;
    pair.vk.struct_size = sizeof pair.vk;
    return pair;
}

/// What every pair below has in common: opaque-fd memory, fences and timeline semaphores.
void setCommon(DriverPair& pair) {
    pair.gl.has_memory_object = pair.gl.has_memory_object_fd = 1;
    pair.gl.has_sync = pair.gl.has_framebuffer_object = 1;
    pair.gl.texture_formats = pair.gl.attachment_formats = kAllFormats;
    pair.vk.has_external_memory_fd = 1;
    pair.vk.has_timeline_semaphore = 1;
    pair.vk.exportable_formats = kAllFormats;
    pair.vk.storage_formats = kAllFormats & ~kDepthFormats & ~bit(SLUICE_FORMAT_SRGB8_A8);
    pair.vk.blendable_formats = kAllFormats & ~kDepthFormats & ~bit(SLUICE_FORMAT_R32UI);
    pair.vk.queue_families = pair.vk.queues = 1;
}

constexpr Uuid kLavapipeDevice{'m', 'e', 's', 'a', '2', '2', '.', '3', '.', '6'};
constexpr Uuid kLavapipeDriver{'l', 'l', 'v', 'm', 'p', 'i', 'p', 'e', 'U', 'U', 'I', 'D'};
// Vendor UUIDs are hashes; these stand for them and have zero bytes inside on purpose.
constexpr Uuid kNvidiaDevice{0x5e, 0x00, 0x7c, 0x91, 0x44, 0x0a, 0x3b, 0xd2,
                             0x88, 0x00, 0x17, 0x6f, 0x9c, 0xe1, 0x05, 0xb3};
constexpr Uuid kNvidiaDriver{0x9a, 0x1f, 0x00, 0x00, 0xc4, 0x6e, 0x51, 0x2d,
                             0xa7, 0x38, 0xf0, 0x0b, 0x62, 0x95, 0xde, 0x4c};
// radv and radeonsi build the device UUID from the PCI address: domain, bus, device, function as 32-bit numbers.
constexpr Uuid kRadeonDevice{0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
constexpr Uuid kRadeonDriver{'A', 'M', 'D', '-', 'M', 'E', 'S', 'A', '-', 'D', 'R', 'V', 0, 0, 0, 0};

}  // namespace

DriverPair recordedMesa22Software() {
    DriverPair pair = named("llvmpipe and lavapipe 22.3.6",
                            "recorded on the reference platform, Debian 12 without a GPU (shared/probes/caps.cpp)");
    setCommon(pair);
    setGlIdentity(pair, kLavapipeDevice, kLavapipeDriver);
    setVkIdentity(pair, kLavapipeDevice, kLavapipeDriver);
    pair.vk.api_version = vulkan1(3, 230);
    pair.vk.storage_formats = 0xff6;    // as vkGetPhysicalDeviceFormatProperties answered
    pair.vk.blendable_formats = 0x7fe;  // likewise
    copyText(pair.gl.vendor, "Mesa");
    copyText(pair.gl.renderer, "llvmpipe (LLVM 15.0.6, 256 bits)");
    copyText(pair.gl.version, "4.5 (Compatibility Profile) Mesa 22.3.6");
    copyText(pair.vk.device_name, "llvmpipe (LLVM 15.0.6, 256 bits)");
    copyText(pair.vk.driver_name, "llvmpipe");
    copyText(pair.vk.driver_info, "Mesa 22.3.6 (LLVM 15.0.6)");
    return pair;
}

DriverPair assumedNvidiaWithTimeline() {
    DriverPair pair =
        named("NVIDIA proprietary with GL_NV_timeline_semaphore", "assumed, from specifications and issue reports");
    setCommon(pair);
    setGlIdentity(pair, kNvidiaDevice, kNvidiaDriver);
    setVkIdentity(pair, kNvidiaDevice, kNvidiaDriver);
    pair.gl.has_semaphore = pair.gl.has_semaphore_fd = pair.gl.has_timeline_semaphore = 1;
    pair.vk.exports_timeline_fd = pair.vk.exports_binary_fd = 1;
    pair.vk.api_version = vulkan1(3, 277);
    pair.vk.queue_families = 3;
    pair.vk.queues = 16;
    copyText(pair.gl.vendor, "NVIDIA Corporation");
    copyText(pair.vk.driver_name, "NVIDIA");
    return pair;
}

DriverPair assumedNvidiaWithoutTimeline() {
    DriverPair pair = assumedNvidiaWithTimeline();
    pair.name = "NVIDIA proprietary, older: GL_EXT_semaphore_fd only";
    pair.gl.has_timeline_semaphore = 0;
    pair.vk.api_version = vulkan1(3, 194);
    return pair;
}

DriverPair assumedRadeonMesa24() {
    DriverPair pair = named("radeonsi and radv, Mesa 24", "assumed, from specifications and issue reports");
    setCommon(pair);
    setGlIdentity(pair, kRadeonDevice, kRadeonDriver);
    setVkIdentity(pair, kRadeonDevice, kRadeonDriver);
    // GL_NV_timeline_semaphore came to radeonsi with Mesa 26.1; radv exports timelines by fd since it uses syncobjs.
    pair.gl.has_semaphore = pair.gl.has_semaphore_fd = 1;
    pair.vk.exports_timeline_fd = pair.vk.exports_binary_fd = 1;
    pair.vk.api_version = vulkan1(3, 278);
    pair.vk.queue_families = 3;
    pair.vk.queues = 6;
    // AMD hardware since GCN has no 24-bit depth, and radv does not offer VK_FORMAT_D24_UNORM_S8_UINT.
    pair.vk.exportable_formats &= ~bit(SLUICE_FORMAT_D24S8);
    copyText(pair.gl.vendor, "AMD");
    copyText(pair.vk.driver_name, "radv");
    return pair;
}

DriverPair assumedHybridLaptop() {
    DriverPair pair = named("hybrid laptop: OpenGL on the AMD GPU, Vulkan on the NVIDIA one",
                            "assumed, from specifications and issue reports");
    const DriverPair radeon = assumedRadeonMesa24();
    const DriverPair nvidia = assumedNvidiaWithTimeline();
    pair.gl = radeon.gl;
    pair.vk = nvidia.vk;
    return pair;
}

}  // namespace sluice::test
