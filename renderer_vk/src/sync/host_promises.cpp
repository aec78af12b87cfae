// SPDX-License-Identifier: MIT
#include "sync/host_promises.hpp"

#include <algorithm>

namespace sluice::vk {

using Clock = std::chrono::steady_clock;

Clock::time_point deadlineIn(std::uint64_t timeout_ns) {
    constexpr std::uint64_t kYear = 31'536'000'000'000'000;  // the sum stays within the clock
    return Clock::now() + std::chrono::nanoseconds(std::min(timeout_ns, kYear));
}

std::uint64_t leftUntil(Clock::time_point deadline) {
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(deadline - Clock::now()).count();
    return static_cast<std::uint64_t>(std::max<std::chrono::nanoseconds::rep>(left, 0));
}

void HostPromises::submitted(std::uint64_t value, std::uint64_t signal) {
    const std::lock_guard guard(lock_);
    promised_ = std::max(promised_, value);
    behind_.emplace_back(promised_, signal);
    release();
}

void HostPromises::kept(std::uint64_t value) {
    const std::lock_guard guard(lock_);
    kept_ = std::max(kept_, value);
    release();
}

void HostPromises::broken() {
    const std::lock_guard guard(lock_);
    broken_ = true;
    changed_.notify_all();
}

void HostPromises::release() {
    while (!behind_.empty() && behind_.front().first <= kept_) {
        free_ = std::max(free_, behind_.front().second);
        behind_.pop_front();
    }
    changed_.notify_all();
}

bool HostPromises::waitUntilKept(std::uint64_t value, Clock::time_point deadline) const {
    std::unique_lock guard(lock_);
    return changed_.wait_until(guard, deadline, [&] { return broken_ || kept_ >= value; });
}

bool HostPromises::waitUntilFree(std::uint64_t signal, Clock::time_point deadline) const {
    std::unique_lock guard(lock_);
    return changed_.wait_until(guard, deadline, [&] { return broken_ || free_ >= signal; });
}

}  // namespace sluice::vk
