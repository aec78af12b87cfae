// SPDX-License-Identifier: MIT
#include "frame/particle_store.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstring>
#include <span>
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

/// What lies on the device, and what it is copied from where the host cannot write that itself.
struct Uploaded {
    Buffer local, staging;
};

Result<Uploaded> upload(const Device& device, std::span<const std::byte> data, const char* name, bool direct) {
    Result<Buffer> written =
        Buffer::create(device, {data.size(), direct ? kUsage : VkBufferUsageFlags{VK_BUFFER_USAGE_TRANSFER_SRC_BIT},
                                BufferPlace::Upload, direct ? name : "particle upload"});
    if (!written) {
        return written.error();
    }
    std::memcpy(written.value().mapped().data(), data.data(), data.size());
    if (direct) {
        return Uploaded{std::move(written).value(), {}};
    }
    Result<Buffer> local =
        Buffer::create(device, {data.size(), kUsage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Device, name});
    if (!local) {
        return local.error();
    }
    return Uploaded{std::move(local).value(), std::move(written).value()};
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
    Result<Uploaded> positions =
        upload(device, std::as_bytes(std::span(particles.position, std::size_t{3} * particles.count)),
               "particle positions", direct);
    if (!positions) {
        return positions.error();
    }
    set->position = std::move(positions.value().local);
    set->staging = std::move(positions.value().staging);
    set->upload_bytes = bytes;
    set->recorded = direct;
    if (particles.fluid != nullptr) {
        Result<Uploaded> numbers =
            upload(device, std::as_bytes(std::span(particles.fluid, particles.count)), "particle fluids", direct);
        if (!numbers) {
            return numbers.error();
        }
        set->fluid = std::move(numbers.value().local);
        set->fluid_staging = std::move(numbers.value().staging);
        set->upload_bytes += set->fluid.size();
    }
    return set;
}

void recordUpload(const Device& device, VkCommandBuffer commands, const ParticleSet& set) {
    if (set.recorded) {
        return;
    }
    const VkBufferCopy region{0, 0, set.position.size()};
    device.fn.vkCmdCopyBuffer(commands, set.staging.buffer(), set.position.buffer(), 1, &region);
    if (set.fluid) {
        const VkBufferCopy numbers{0, 0, set.fluid.size()};
        device.fn.vkCmdCopyBuffer(commands, set.fluid_staging.buffer(), set.fluid.buffer(), 1, &numbers);
    }
    memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                  VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT);
}

}  // namespace sluice::vk
