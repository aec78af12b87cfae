// SPDX-License-Identifier: MIT
#include "stress/process/carry.hpp"

#include "sluice/isolate/channel.hpp"

namespace sluice::stress {
namespace {

constexpr std::uint64_t kLookNs = 20'000'000;  ///< how soon a thread that waits for the queue notices the end

}  // namespace

Carry::Carry(VkSide& side, isolate::SharedTimeline& timeline)
    : side_(side), timeline_(timeline), host_([this] { carryHost(); }), queue_([this] { carryQueue(); }) {}

Carry::~Carry() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    timeline_.peerDied();  // as good as: nothing that the host still publishes is to be carried
    host_.join();
    queue_.join();
}

void Carry::expect(std::uint64_t value) {
    {
        const std::lock_guard lock(mutex_);
        expected_.push_back(value);
    }
    changed_.notify_all();
}

void Carry::carryHost() {
    std::uint64_t given = 0;
    for (;;) {
        const isolate::WaitEnd end = timeline_.wait(SLUICE_HOST_TO_RENDERER, given + 1, isolate::kForever);
        if (end == isolate::WaitEnd::Broken) {
            timeline_.fail(SLUICE_ERROR_INVALID_ARGUMENT);
        }
        if (end != isolate::WaitEnd::Reached) {
            return;
        }
        given = timeline_.value(SLUICE_HOST_TO_RENDERER);
        if (const Status status = side_.signal(given); !status) {
            timeline_.fail(status.error().code);
            return;
        }
    }
}

void Carry::carryQueue() {
    for (;;) {
        std::uint64_t value = 0;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [this] { return stop_ || !expected_.empty(); });
            if (stop_) {
                return;
            }
            value = expected_.front();
        }
        const SluiceResult result = side_.wait(value, kLookNs);
        if (result == SLUICE_TIMEOUT) {
            continue;
        }
        const bool told = result == SLUICE_OK && timeline_.publish(SLUICE_RENDERER_TO_HOST, value).ok();
        if (!told) {
            timeline_.fail(result == SLUICE_OK ? SLUICE_ERROR_INTERNAL : result);
            return;
        }
        const std::lock_guard lock(mutex_);
        expected_.pop_front();
    }
}

}  // namespace sluice::stress
