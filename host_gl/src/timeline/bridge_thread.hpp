// SPDX-License-Identifier: MIT
// The thread that turns GL fences into timeline values.
#pragma once

#include <epoxy/gl.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "sluice/result.hpp"
#include "timeline/bridge_context.hpp"
#include "timeline/host_timeline.hpp"

namespace sluice::host {

/// Waits for fences in the order in which they were promised, and signals each value once its fence has arrived.
///
/// A value is signalled even when its fence fails or does not arrive before the end of the drain: the renderer's queue
/// may be waiting for it, and a wait that is never satisfied would hang the renderer's destruction. The failure is kept
/// and told through takeError().
class BridgeThread {
  public:
    /// Returns once the thread has made its context current, or why it could not.
    [[nodiscard]] static Result<std::unique_ptr<BridgeThread>> start(BridgeContext context, const TimelineDeps& deps);
    BridgeThread(const BridgeThread&) = delete;
    BridgeThread& operator=(const BridgeThread&) = delete;
    /// Drains what was promised, for deps.drain_timeout_ns at most.
    ~BridgeThread();

    /// Takes the fence, whose command must have been flushed. Values increase. GL thread.
    void promise(GLsync fence, std::uint64_t value);
    /// Waits until everything promised up to `value` has been signalled (and the calls that did so have returned), for
    /// `timeout_ns` at most. False if the time passed or the bridge failed meanwhile. GL thread.
    [[nodiscard]] bool waitUntilKept(std::uint64_t value, std::uint64_t timeout_ns);
    /// The first failure since the last call. GL thread.
    [[nodiscard]] std::optional<Error> takeError();
    /// True while takeError() has something to tell.
    [[nodiscard]] const std::atomic<bool>& failed() const { return failed_; }

  private:
    struct Promise {
        GLsync fence;
        std::uint64_t value;
    };

    BridgeThread(BridgeContext context, TimelineDeps deps);
    void run();
    /// `idle_ns`: since when the thread had nothing to do.
    void keep(const Promise& promise, std::uint64_t idle_ns);
    [[nodiscard]] Status waitForFence(const Promise& promise) const;
    void fail(const Error& error);

    BridgeContext context_;
    TimelineDeps deps_;
    std::mutex mutex_;
    std::condition_variable wake_, started_, kept_changed_;
    std::deque<Promise> promises_;           // guarded by mutex_
    std::optional<Status> start_;            // guarded by mutex_
    std::optional<Error> error_;             // guarded by mutex_
    std::uint64_t promised_ = 0, kept_ = 0;  // guarded by mutex_; the last value of each
    bool stop_ = false;                      // guarded by mutex_
    std::atomic<bool> failed_{false};
    std::atomic<std::uint64_t> deadline_{0};  // of the drain, monotonic nanoseconds; 0: not stopping
    std::thread thread_;
};

}  // namespace sluice::host
