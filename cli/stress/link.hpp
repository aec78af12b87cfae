// SPDX-License-Identifier: MIT
// What host_gl's timelines signal and wait through: the seam of the C ABI, where the stress test keeps its book and
// breaks things.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "stress/book.hpp"
#include "stress/plan.hpp"
#include "stress/vk/side.hpp"

namespace sluice::stress {

/// Made on the host's thread. With a relay two threads stand between OpenGL and the renderer, one per direction.
/// Pinned; dies after the host's timeline and before the Vulkan side's resources.
class Link {
  public:
    /// Keeps the book: a link that is abandoned with a stuck queue goes on writing into it.
    Link(VkSide& vulkan, std::shared_ptr<Book> book, bool relay);
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;
    ~Link();

    [[nodiscard]] const SluiceRendererApi& api() const { return api_; }
    [[nodiscard]] SluiceRenderer* renderer() { return reinterpret_cast<SluiceRenderer*>(this); }

    /// What happens to the signal of `value`, before it is promised: Drop, Delay, Duplicate, or Swap, which gives
    /// `other` in its place.
    void arm(Fault fault, std::uint64_t value, std::uint32_t delay_us, std::uint64_t other = 0);
    /// A relay has these values to pass on: from OpenGL, and from the queue.
    void expectSignal(std::uint64_t value);
    void expectBack(std::uint64_t value);

    /// In the place of a signal that was dropped: raises the timeline to `value`, marked as forced.
    [[nodiscard]] Status rescue(std::uint64_t value);
    /// Waits until the signal of `value` has been given or dropped. False after the timeout.
    [[nodiscard]] bool settled(std::uint64_t value, std::uint64_t timeout_ns);

    /// The last value whose signal was dropped.
    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
    /// Up to here every signal has been given or dropped.
    [[nodiscard]] std::uint64_t past();
    /// Signals that the renderer's own guard refused: the second ones of duplicates and of swaps.
    [[nodiscard]] std::uint64_t refused() const { return refused_; }

  private:
    struct Armed {
        Fault fault;
        std::uint32_t delay_us;
        std::uint64_t other;
    };
    /// Values that a relay thread has still to pass on.
    struct Post {
        std::mutex mutex;
        std::condition_variable wake;
        std::deque<std::uint64_t> values;
        bool stop = false;
        void push(std::uint64_t value);
        void end();
        [[nodiscard]] std::optional<std::uint64_t> pop();
        [[nodiscard]] bool ended();
    };

    static SluiceResult onSignal(SluiceRenderer* renderer, std::uint64_t value);
    static SluiceResult onWait(SluiceRenderer* renderer, std::uint64_t value, std::uint64_t timeout_ns);
    [[nodiscard]] SluiceResult fromGl(std::uint64_t value);
    [[nodiscard]] SluiceResult wait(std::uint64_t value, std::uint64_t timeout_ns);
    /// Raises host-to-renderer, or what is armed instead.
    [[nodiscard]] SluiceResult raise(ledger::ActorId by, std::uint64_t value);
    void relayOut();
    void relayBack();

    VkSide& vulkan_;
    std::shared_ptr<Book> book_;
    SluiceRendererApi api_{};
    std::thread::id host_thread_ = std::this_thread::get_id();
    bool relay_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::uint64_t, Armed> armed_;  // guarded by mutex_
    std::uint64_t raised_ = 0;              // guarded by mutex_
    std::atomic<std::uint64_t> dropped_{0}, refused_{0};
    Post out_, back_;
    std::thread out_thread_, back_thread_;
};

}  // namespace sluice::stress
