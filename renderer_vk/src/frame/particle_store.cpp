// SPDX-License-Identifier: MIT
#include "frame/particle_store.hpp"

#include <fmt/format.h>

#include <cstring>
#include <utility>

#include "device/capabilities.hpp"
#include "device/commands.hpp"

namespace sluice::vk {
namespace {

constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;

/// The CPU can write where the GPU reads, and no copy is needed: the largest local heap is host-visible. A small window
/// of 256 MiB beside a large heap does not count; it is soon full.
bool writesLocalMemory(const Device& device) {
    constexpr VkMemoryPropertyFlags kAll = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                           VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const Result<std::uint32_t> type = device.memoryType(~0U, kAll);
    if (!type) {
        return false;
    }
    const VkDeviceSize window = device.memory.memoryHeaps[device.memory.memoryTypes[type.value()].heapIndex].size;
    for (std::uint32_t i = 0; i < device.memory.memoryHeapCount; ++i) {
        const VkMemoryHeap& heap = device.memory.memoryHeaps[i];
        if ((heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0 && heap.size > window) {
            return false;
        }
    }
    return true;
}

}  // namespace

Result<std::shared_ptr<ParticleSet>> createParticleSet(const Device& device, const SluiceParticles& particles) {
    auto set = std::make_shared<ParticleSet>();
    set->count = particles.count;
    set->radius = particles.radius;
    set->recorded = true;
    if (particles.count == 0) {
        return set;
    }
    const std::uint64_t bytes = particles.count * kPositionBytes;
    const std::uint64_t limit = device.properties.limits.maxStorageBufferRange;
    if (bytes > limit) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "particles",
                     fmt::format("{} particles need a buffer of {} bytes, this device binds at most {}",
                                 particles.count, bytes, limit),
                     fmt::format("use at most {} particles", limit / kPositionBytes)};
    }
    const bool direct = !device.switches.stage_uploads && writesLocalMemory(device);
    Result<Buffer> upload =
        Buffer::create(device, {bytes, direct ? kUsage : VkBufferUsageFlags{VK_BUFFER_USAGE_TRANSFER_SRC_BIT},
                                BufferPlace::Upload, direct ? "particle positions" : "particle upload"});
    if (!upload) {
        return upload.error();
    }
    std::memcpy(upload.value().mapped().data(), particles.position, bytes);
    set->upload_bytes = bytes;
    if (direct) {
        set->position = std::move(upload).value();
        return set;
    }
    Result<Buffer> local = Buffer::create(
        device, {bytes, kUsage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Device, "particle positions"});
    if (!local) {
        return local.error();
    }
    set->position = std::move(local).value();
    set->staging = std::move(upload).value();
    set->recorded = false;
    return set;
}

void recordUpload(const Device& device, VkCommandBuffer commands, const ParticleSet& set) {
    if (set.recorded) {
        return;
    }
    const VkBufferCopy region{0, 0, set.position.size()};
    device.fn.vkCmdCopyBuffer(commands, set.staging.buffer(), set.position.buffer(), 1, &region);
    memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                  VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT);
}

}  // namespace sluice::vk
