// SPDX-License-Identifier: MIT
// Between the counters in shared memory and the semaphores of a Vulkan side in the same process.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <thread>

#include "sluice/isolate/shared_timeline.hpp"
#include "stress/vk/side.hpp"

namespace sluice::stress {

/// Two threads, one per direction. interop's carriers do the same for a renderer's table of functions, frame by frame;
/// the values here jump, by up to 10,000, and so do the carriers.
class Carry {
  public:
    /// Both must outlive it. `timeline` is of no use afterwards.
    Carry(VkSide& side, isolate::SharedTimeline& timeline);
    Carry(const Carry&) = delete;
    Carry& operator=(const Carry&) = delete;
    ~Carry();

    /// A submission will signal `value`, which is more than those before.
    void expect(std::uint64_t value);

  private:
    void carryHost();
    void carryQueue();

    VkSide& side_;
    isolate::SharedTimeline& timeline_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::uint64_t> expected_;
    bool stop_ = false;
    std::thread host_, queue_;
};

}  // namespace sluice::stress
