// SPDX-License-Identifier: MIT
#include "simulation/buffers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/structs.hpp"
#include "simulation/kernels.hpp"

namespace sluice::vk {
namespace {

/// Room for so many in one step to begin with.
constexpr std::uint32_t kFirstBirths = 256;

struct SlotSize {
    const char* name;
    VkDeviceSize bytes;
    VkFormat texels = VK_FORMAT_UNDEFINED;
};

SlotSize sizeOf(Slot slot, const SimulationBuffers& b) {
    constexpr VkDeviceSize kVector = 16;
    constexpr VkDeviceSize kWord = 4;
    const VkDeviceSize n = b.particles;
    switch (slot) {
        case Slot::Parameters:
            return {"simulation parameters", sizeof(Parameters)};
        case Slot::PositionIn:
        case Slot::PositionOut:
            return {"simulation positions", n * kVector};
        case Slot::VelocityIn:
        case Slot::VelocityOut:
            return {"simulation velocities", n * kVector};
        case Slot::IdentityIn:
        case Slot::IdentityOut:
            return {"simulation identities", n * kWord};
        case Slot::Predicted:
            return {"simulation predicted", n * kVector};
        case Slot::Arrival:
            return {"simulation arrival", n * 2 * kWord};
        case Slot::Cells:
            return {"simulation cells", (VkDeviceSize{b.cells} + 1) * kWord, VK_FORMAT_R32_UINT};
        case Slot::Sums:
            return {"simulation sums", (VkDeviceSize{b.cells} / kScanBlock + 1) * kWord};
        case Slot::Bucket:
            return {"simulation buckets", n * kWord};
        case Slot::Sorted:
            return {"simulation sorted", n * kVector, VK_FORMAT_R32G32B32A32_SFLOAT};
        case Slot::Before:
            return {"simulation before", n * kVector};
        case Slot::Pushed:
            return {"simulation pushed", n * kVector, VK_FORMAT_R32G32B32A32_SFLOAT};
        case Slot::Walls:
            return {"simulation walls", n * kVector, VK_FORMAT_R32G32B32A32_SFLOAT};
        case Slot::List:
            return {"simulation lists", VkDeviceSize{b.stride()} * b.neighbours * kWord, VK_FORMAT_R32_UINT};
        case Slot::ListCount:
            return {"simulation list lengths", n * kWord};
        case Slot::Moving:
            return {"simulation moving", n * kVector, VK_FORMAT_R32G32B32A32_SFLOAT};
        case Slot::Curl:
            return {"simulation curl", n * kVector, VK_FORMAT_R32G32B32A32_SFLOAT};
        case Slot::Sources:
            return {"simulation sources", sizeof(SourceBlock)};
        case Slot::Births:
            return {"simulation births", VkDeviceSize{b.births} * 2 * kVector};
        case Slot::Blocked:
            return {"simulation births that are blocked", VkDeviceSize{b.births} * kWord};
        case Slot::Bodies:
            return {"simulation bodies", sizeof(BodyBlock)};
        case Slot::Pushes:
            return {"simulation pushes", kPushBytes};
        case Slot::Status:
        case Slot::Count:
        case Slot::Meshes:
        case Slot::Seen:
            break;
    }
    return {"simulation status", sizeof(StepStatus)};
}

struct MadeSlot {
    Buffer buffer;
    TexelView texels;
};

/// As `buffers` says, which keeps what it has.
Result<MadeSlot> makeSlot(const Device& device, const SimulationBuffers& buffers, Slot slot) {
    const SlotSize size = sizeOf(slot, buffers);
    const VkDeviceSize texel = size.texels == VK_FORMAT_R32_UINT ? 4 : 16;
    const VkPhysicalDeviceLimits& limits = device.properties.limits;
    // Lists are only ever read and written as texels, so that the range of a storage buffer is no bound for them.
    const bool as_texels = slot == Slot::List;
    const VkDeviceSize most = std::min(
        as_texels ? ~VkDeviceSize{0} : VkDeviceSize{limits.maxStorageBufferRange},
        size.texels == VK_FORMAT_UNDEFINED ? ~VkDeviceSize{0} : texel * VkDeviceSize{limits.maxTexelBufferElements});
    if (size.bytes > most) {
        return Error{SLUICE_ERROR_UNSUPPORTED, size.name,
                     fmt::format("{} bytes for {} particles are more than the device's buffers hold ({})", size.bytes,
                                 buffers.particles, most),
                     "simulate fewer particles"};
    }
    const bool uniform = slot == Slot::Parameters || slot == Slot::Sources || slot == Slot::Bodies;
    const bool written_by_host = uniform || slot == Slot::Births;
    VkBufferUsageFlags usage = uniform ? VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT
                                       : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                             VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (size.texels != VK_FORMAT_UNDEFINED) {
        usage |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
        if (as_texels) {
            usage |= VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
        }
    }
    Result<Buffer> buffer = Buffer::create(
        device, {size.bytes, usage, written_by_host ? BufferPlace::Upload : BufferPlace::Device, size.name});
    if (!buffer) {
        return buffer.error();
    }
    MadeSlot made{std::move(buffer).value(), {}};
    if (size.texels != VK_FORMAT_UNDEFINED) {
        Result<TexelView> view = TexelView::create(device, made.buffer, size.texels, size.name);
        if (!view) {
            return view.error();
        }
        made.texels = std::move(view).value();
    }
    return made;
}

void put(SimulationBuffers& buffers, Slot slot, MadeSlot made) {
    const auto index = static_cast<std::size_t>(slot);
    buffers.texels.at(index) = std::move(made.texels);
    made.texels = {};  // the view of the buffer that goes now
    buffers.slots.at(index) = std::move(made.buffer);
}

}  // namespace

TexelView::TexelView(TexelView&& other) noexcept {
    *this = std::move(other);
}

TexelView& TexelView::operator=(TexelView&& other) noexcept {
    std::swap(handle, other.handle);
    std::swap(device_, other.device_);
    return *this;
}

TexelView::~TexelView() {
    if (device_ != nullptr) {
        device_->fn.vkDestroyBufferView(device_->handle, handle, nullptr);
    }
}

Result<TexelView> TexelView::create(const Device& device, const Buffer& buffer, VkFormat format, const char* name) {
    auto info = vkStruct<VkBufferViewCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO);
    info.buffer = buffer.buffer();
    info.format = format;
    info.range = VK_WHOLE_SIZE;
    TexelView view;
    view.device_ = &device;
    if (const VkResult result = device.fn.vkCreateBufferView(device.handle, &info, nullptr, &view.handle);
        result != VK_SUCCESS) {
        return vulkanError(result, fmt::format("texel view of {}", name));
    }
    return view;
}

Result<SimulationBuffers> createBuffers(const Device& device, std::uint32_t particles, std::uint32_t neighbours,
                                        std::uint32_t cells) {
    SimulationBuffers buffers;
    buffers.particles = particles;
    buffers.neighbours = neighbours;
    buffers.cells = cells;
    buffers.births = kFirstBirths;
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
        Result<MadeSlot> made = makeSlot(device, buffers, static_cast<Slot>(slot));
        if (!made) {
            return made.error();
        }
        put(buffers, static_cast<Slot>(slot), std::move(made).value());
    }
    Result<Buffer> read_back =
        Buffer::create(device, {sizeof(StepStatus) + kPushBytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                BufferPlace::Readback, "simulation status for the host"});
    if (!read_back) {
        return read_back.error();
    }
    buffers.read_back = std::move(read_back).value();
    return buffers;
}

Status growLists(const Device& device, SimulationBuffers& buffers, std::uint32_t neighbours) {
    const std::uint32_t before = std::exchange(buffers.neighbours, neighbours);
    Result<MadeSlot> list = makeSlot(device, buffers, Slot::List);
    if (!list) {
        buffers.neighbours = before;
        return list.error();
    }
    put(buffers, Slot::List, std::move(list).value());
    return {};
}

Status growBirths(const Device& device, SimulationBuffers& buffers, std::uint32_t births) {
    const std::uint32_t before = std::exchange(buffers.births, births);
    Result<MadeSlot> born = makeSlot(device, buffers, Slot::Births);
    Result<MadeSlot> blocked = born ? makeSlot(device, buffers, Slot::Blocked) : Result<MadeSlot>{born.error()};
    if (!blocked) {
        buffers.births = before;
        return blocked.error();
    }
    put(buffers, Slot::Births, std::move(born).value());
    put(buffers, Slot::Blocked, std::move(blocked).value());
    return {};
}

}  // namespace sluice::vk
