// SPDX-License-Identifier: MIT
// How far the CPU has signalled what submissions wait for.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <utility>

namespace sluice::vk {

/// The point in time so many nanoseconds from now, however many.
[[nodiscard]] std::chrono::steady_clock::time_point deadlineIn(std::uint64_t timeout_ns);
/// What is left until then, 0 if it has passed.
[[nodiscard]] std::uint64_t leftUntil(std::chrono::steady_clock::time_point deadline);

/// Values of the host that submissions wait for: promised with the submission, kept when the call of vkSignalSemaphore
/// has returned. Work behind a promise cannot end before it is kept, so a wait for that work comes here first and loses
/// nothing. What it gains: no thread hears of the end of that work while another is still inside the call, where
/// validation layer 1.3.239 waits for itself (docs/validation.md). From any thread.
class HostPromises {
  public:
    /// A submission will signal `signal`, and it stands behind the host's `value`, or, with 0, behind what was promised
    /// before.
    void submitted(std::uint64_t value, std::uint64_t signal);
    /// The call that signals `value` has returned.
    void kept(std::uint64_t value);
    /// A call that should have signalled has failed: nobody waits here from now on, what they wait for says why.
    void broken();

    /// Waits until `value` has been kept, or a promise is broken; false: neither by then.
    [[nodiscard]] bool waitUntilKept(std::uint64_t value, std::chrono::steady_clock::time_point deadline) const;
    /// Waits until what signals `signal` has been submitted and every promise before it has been kept, or one is
    /// broken.
    [[nodiscard]] bool waitUntilFree(std::uint64_t signal, std::chrono::steady_clock::time_point deadline) const;

  private:
    void release();

    mutable std::mutex lock_;  ///< guards all below
    mutable std::condition_variable changed_;
    std::deque<std::pair<std::uint64_t, std::uint64_t>>
        behind_;  ///< value and signal, both rising, of what is not free
    std::uint64_t promised_ = 0;
    std::uint64_t kept_ = 0;
    std::uint64_t free_ = 0;  ///< the last signal that stands behind no promise
    bool broken_ = false;
};

/// One of them.
struct HostPromise {
    std::shared_ptr<const HostPromises> of;  ///< null: none
    std::uint64_t value = 0;
};

}  // namespace sluice::vk
