// SPDX-License-Identifier: MIT
// The counters of a renderer that OpenGL cannot reach, carried between its table of functions and the shared memory.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <thread>

#include "sluice/isolate/messages.hpp"
#include "sluice/isolate/shared_timeline.hpp"
#include "sluice/plugin.h"

namespace sluice::isolate {

/// The renderer dies as the host's Hello has asked, if it has. Does not return then.
void dieIfAsked(const Hello& hello, std::uint64_t frame, bool in_submit);

/// A submitted frame waits for `wait_value` (0: for none) and will reach `signal_value`.
struct Promise {
    std::uint64_t wait_value = 0, signal_value = 0;
};

/// Two threads: host's values to timeline_signal, timeline_wait to renderer's values. They end before the renderer
/// does.
class Carriers {
  public:
    /// `api`, `renderer` and `timeline` must outlive it.
    Carriers(const SluiceRendererApi& api, SluiceRenderer* renderer, SharedTimeline& timeline, const Hello& hello);
    Carriers(const Carriers&) = delete;
    Carriers& operator=(const Carriers&) = delete;
    ~Carriers();

    /// Brings every value that the host has published to the renderer; they are there when it returns. Any thread.
    void forward();
    /// The value of that frame is published once the renderer has reached it.
    void promise(const Promise& promise);
    /// Publishes what the renderer has reached by now. Any thread.
    void publishReached();

  private:
    void carryHost();
    void carryRenderer();
    /// Blocks until the renderer has reached the promise; false: it never will, or the end has come.
    [[nodiscard]] bool reached(const Promise& promise);

    const SluiceRendererApi& api_;
    SluiceRenderer* renderer_;
    SharedTimeline& timeline_;
    Hello hello_;
    std::atomic<bool> stop_{false};
    std::mutex forward_mutex_;
    std::uint64_t forwarded_ = 0;
    std::mutex publish_mutex_;
    std::uint64_t published_ = 0;
    std::mutex mutex_;
    std::condition_variable promised_;
    std::deque<Promise> promises_;
    std::thread host_, renderer_thread_;
};

}  // namespace sluice::isolate
