// SPDX-License-Identifier: MIT
#include "live/seen_depths.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace sluice::vk {

std::uint64_t SeenDepths::sourceOf(std::uint64_t value) const {
    if (value < 2) {
        return 0;
    }
    return value > lag_ ? std::max<std::uint64_t>(value - lag_, 1) : 1;
}

Result<std::shared_ptr<const Buffer>> SeenDepths::room(const Device& device, VkDeviceSize bytes) {
    const auto idle = [](const auto& buffer) { return buffer.use_count() == 1; };
    for (const auto& buffer : buffers_) {
        if (idle(buffer) && buffer->size() == bytes) {
            return buffer;
        }
    }
    // Of another size: the pictures have been resized.
    buffers_.erase(std::remove_if(buffers_.begin(), buffers_.end(),
                                  [&](const auto& buffer) { return idle(buffer) && buffer->size() != bytes; }),
                   buffers_.end());
    Result<Buffer> made = Buffer::create(
        device, {bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::Device, "captured depth", true});
    if (!made) {
        return made.error();
    }
    return buffers_.emplace_back(std::make_shared<const Buffer>(std::move(made).value()));
}

void SeenDepths::drawn(std::uint64_t value, SeenDepth captured) {
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
