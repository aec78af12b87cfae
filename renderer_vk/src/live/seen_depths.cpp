// SPDX-License-Identifier: MIT
#include "live/seen_depths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "sluice/roles.hpp"

namespace sluice::vk {

std::string DepthBuffer::name() const {
    return fmt::format("{} {}", kCapturedDepth, number);
}

std::uint64_t SeenDepths::sourceOf(std::uint64_t value) const {
    if (value < 2) {
        return 0;
    }
    return value > lag_ ? std::max<std::uint64_t>(value - lag_, 1) : 1;
}

Result<DepthRoom> SeenDepths::room(const Device& device, VkDeviceSize bytes) {
    const VkDeviceSize most = device.properties.limits.maxStorageBufferRange;
    if (bytes > most) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "captured depth",
                     fmt::format("it needs a buffer of {} bytes, this device binds at most {}", bytes, most),
                     "raise simulation.depth_scale, or draw smaller frames"};
    }
    const auto idle = [](const auto& buffer) { return buffer.use_count() == 1; };
    for (const auto& buffer : buffers_) {
        if (idle(buffer) && buffer->memory.size() == bytes) {
            return DepthRoom{buffer, freed_[buffer->number]};
        }
    }
    // Of another size: the pictures have been resized.
    buffers_.erase(std::remove_if(buffers_.begin(), buffers_.end(),
                                  [&](const auto& buffer) { return idle(buffer) && buffer->memory.size() != bytes; }),
                   buffers_.end());
    Result<Buffer> made = Buffer::create(
        device, {bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::Device, "captured depth", true});
    if (!made) {
        return made.error();
    }
    const auto taken = [this](std::uint32_t number) {
        return std::any_of(buffers_.begin(), buffers_.end(),
                           [number](const auto& buffer) { return buffer->number == number; });
    };
    DepthBuffer buffer{std::move(made).value(), 0};
    while (taken(buffer.number)) {
        ++buffer.number;
    }
    freed_.resize(std::max<std::size_t>(freed_.size(), buffer.number + 1));
    buffers_.push_back(std::make_shared<const DepthBuffer>(std::move(buffer)));
    return DepthRoom{buffers_.back(), freed_[buffers_.back()->number]};
}

void SeenDepths::letGo(const DepthBuffer& buffer, std::uint64_t freed) {
    freed_[buffer.number] = freed;
}

void SeenDepths::drawn(std::uint64_t value, SeenDepth captured) {
    if (captured.buffer != nullptr && captured.buffer->number < freed_.size()) {
        freed_[captured.buffer->number] = 0;  // the frame comes after that, and all frames after this one
    }
    if (value <= known_) {
        return;
    }
    known_ = value;
    if (captured.buffer != nullptr) {
        seen_.insert_or_assign(value, std::move(captured));
    }
}

void SeenDepths::passed(std::uint64_t value) {
    known_ = std::max(known_, value);
}

SeenDepth SeenDepths::at(std::uint64_t value) const {
    const auto after = seen_.upper_bound(value);
    return after == seen_.begin() ? SeenDepth{} : std::prev(after)->second;
}

void SeenDepths::forget(std::uint64_t value) {
    const auto after = seen_.upper_bound(value);
    if (after != seen_.begin()) {
        seen_.erase(seen_.begin(), std::prev(after));
    }
}

}  // namespace sluice::vk
