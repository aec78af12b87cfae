// SPDX-License-Identifier: MIT
// One exportable binary semaphore per timeline value, for OpenGL drivers without timelines (GL_EXT_semaphore_fd).
#pragma once

#include <volk.h>

#include <cstdint>
#include <map>

#include "device/device.hpp"
#include "sluice/fd.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// The semaphores of one direction, by value. Not thread-safe. Dies before its Device, with no submitted work left.
class BinaryPool {
  public:
    explicit BinaryPool(const Device& device) : device_(device) {}
    BinaryPool(const BinaryPool&) = delete;
    BinaryPool& operator=(const BinaryPool&) = delete;
    ~BinaryPool();

    /// The semaphore of `value`, or null.
    [[nodiscard]] VkSemaphore find(std::uint64_t value) const;
    /// The semaphore of `value`, created on first use.
    [[nodiscard]] Result<VkSemaphore> obtain(std::uint64_t value);
    /// A new opaque fd for the semaphore of `value`. Both sides then refer to one payload, so ours may be destroyed
    /// while the other side still uses its own.
    [[nodiscard]] Result<UniqueFd> exportFd(std::uint64_t value);
    /// Destroys the semaphores of all values up to `value`; the queue must be done with them.
    void retireThrough(std::uint64_t value);
    [[nodiscard]] std::size_t size() const { return semaphores_.size(); }

  private:
    const Device& device_;
    std::map<std::uint64_t, VkSemaphore> semaphores_;
};

/// A new semaphore; `exportable` adds OPAQUE_FD export.
[[nodiscard]] Result<VkSemaphore> createSemaphore(const Device& device, VkSemaphoreType type, bool exportable,
                                                  const char* name);
[[nodiscard]] Result<UniqueFd> exportSemaphore(const Device& device, VkSemaphore semaphore);

}  // namespace sluice::vk
