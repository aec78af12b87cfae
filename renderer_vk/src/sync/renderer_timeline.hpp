// SPDX-License-Identifier: MIT
// The renderer's end of the two counters, for every kind of timeline.
#pragma once

#include <volk.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "device/device.hpp"
#include "sluice/fd.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "sync/binary_pool.hpp"
#include "sync/host_promises.hpp"

namespace sluice::vk {

/// Semaphores of one submission.
struct SubmitSemaphores {
    std::vector<VkSemaphoreSubmitInfo> waits, signals;
};

/// How the queue ended.
enum class Drained : std::uint8_t {
    Idle,
    Lost,  ///< the device is lost: nothing runs any more, everything may be destroyed
    Stuck  ///< a submission waits for a binary semaphore that OpenGL never signalled: nothing may be destroyed
};

/// Each direction is a Vulkan timeline semaphore. NATIVE exports both; BINARY adds one exported binary semaphore per
/// value and keeps the renderer-to-host timeline for its own bookkeeping; the other kinds use them from the CPU.
/// signal, wait and value may be called from any thread, the rest on the renderer's thread only.
class RendererTimeline {
  public:
    static Result<std::unique_ptr<RendererTimeline>> create(const Device& device, SluiceTimelineKind kind);

    RendererTimeline(const Device& device, SluiceTimelineKind kind);
    RendererTimeline(const RendererTimeline&) = delete;
    RendererTimeline& operator=(const RendererTimeline&) = delete;
    /// The queue must be done with every submission; see drain().
    ~RendererTimeline();

    [[nodiscard]] SluiceTimelineKind kind() const { return kind_; }

    /// What the submission of a frame waits for and signals. With `skip_wait`, or UNSYNCHRONISED, it waits for nothing.
    /// BINARY fails if the host has not asked for the semaphore of `wait_value`; FINISH if the host has not signalled
    /// it, because the wait for the queue that follows would never end.
    [[nodiscard]] Result<SubmitSemaphores> forSubmit(std::uint64_t wait_value, std::uint64_t signal_value,
                                                     bool skip_wait);
    /// What such a submission waits for, where that is for the CPU to signal; else none. For Device::submit.
    [[nodiscard]] HostPromise promiseOf(std::uint64_t wait_value, bool skip_wait) const;
    /// The submission that forSubmit was asked for has reached the queue.
    void submitted(std::uint64_t wait_value, std::uint64_t signal_value, bool skip_wait);

    /// The host-to-renderer counter reaches `value` now. Must increase. Only for kinds that the CPU signals.
    [[nodiscard]] Status signal(std::uint64_t value);
    /// Blocks until the renderer-to-host counter has reached `value`, and no sooner than signal() of what that waits
    /// for has returned: OK, TIMEOUT or a failure.
    [[nodiscard]] SluiceResult wait(std::uint64_t value, std::uint64_t timeout_ns) const;
    /// The counter now. BINARY knows the host's only as far as finished frames prove it.
    [[nodiscard]] Result<std::uint64_t> value(SluiceDirection direction) const;
    [[nodiscard]] Result<UniqueFd> exportFd(SluiceDirection direction, std::uint64_t value);

    /// Frame `frame` is done, and so is the host with what was exported for it: binary semaphores are destroyed.
    void retireFrame(std::uint64_t frame);

    /// What drain() makes of its grace: where GL signals by itself (NATIVE, BINARY), after work of any length, ten
    /// seconds at least.
    [[nodiscard]] static std::uint64_t graceOf(SluiceTimelineKind kind, std::uint64_t grace_ns);
    /// Waits until every submission has finished. If neither counter moves for graceOf(kind, grace_ns) and a submission
    /// waits for a host value that has not come, a timeline semaphore is moved on by force, with a warning in the log.
    /// Binary semaphores cannot be.
    [[nodiscard]] Drained drain(std::uint64_t grace_ns);
    /// Up to which host value drain() has moved the counter on by force, 0: never. Not while another thread drains.
    [[nodiscard]] std::uint64_t forced() const { return forced_; }

  private:
    [[nodiscard]] bool cpuSignals() const;
    [[nodiscard]] Drained idle() const;
    /// Waits for the last submission until neither counter has moved for `grace_ns`.
    [[nodiscard]] SluiceResult waitWhileMoving(std::uint64_t grace_ns) const;
    void force(std::uint64_t from, std::uint64_t through);

    const Device& device_;
    SluiceTimelineKind kind_;
    VkSemaphore host_to_renderer_ = VK_NULL_HANDLE;
    VkSemaphore renderer_to_host_ = VK_NULL_HANDLE;
    BinaryPool binary_host_to_renderer_;
    BinaryPool binary_renderer_to_host_;
    std::shared_ptr<HostPromises> promises_ = std::make_shared<HostPromises>();
    std::uint64_t last_wait_ = 0;    ///< highest host value that a submission waits for
    std::uint64_t last_signal_ = 0;  ///< highest renderer value that a submission will signal
    std::mutex signal_lock_;         ///< guards signalled_ and forced_
    std::uint64_t signalled_ = 0;
    std::uint64_t forced_ = 0;  ///< up to here drain() has signalled for the host; late signals are accepted
};

}  // namespace sluice::vk
