// SPDX-License-Identifier: MIT
#include "isolate/carriers.hpp"

#include <sys/prctl.h>

#include <csignal>

namespace sluice::isolate {

namespace {

/// How soon a blocked thread notices that it shall end.
constexpr std::uint64_t kSliceNs = 20'000'000;

}  // namespace

void dieIfAsked(const Hello& hello, std::uint64_t frame, bool in_submit) {
    if (hello.fault_signal == 0 || frame != hello.fault_frame || in_submit != (hello.fault_in_submit != 0)) {
        return;
    }
    const auto number = static_cast<int>(hello.fault_signal);
    (void)::prctl(PR_SET_DUMPABLE, 0);   // on purpose, so no core is of use
    (void)std::signal(number, SIG_DFL);  // a sanitizer's handler would make an exit code of it
    (void)std::raise(number);
}

Carriers::Carriers(const SluiceRendererApi& api, SluiceRenderer* renderer, SharedTimeline& timeline, const Hello& hello)
    : api_(api),
      renderer_(renderer),
      timeline_(timeline),
      hello_(hello),
      host_([this] { carryHost(); }),
      renderer_thread_([this] { carryRenderer(); }) {}

Carriers::~Carriers() {
    stop_ = true;
    timeline_.wake();
    { const std::lock_guard lock(mutex_); }
    promised_.notify_all();
    host_.join();
    renderer_thread_.join();
    forward();  // what came last; the renderer's end may wait for it
}

void Carriers::forward() {
    const std::lock_guard lock(forward_mutex_);
    const WaitEnd end = timeline_.wait(SLUICE_HOST_TO_RENDERER, forwarded_ + 1, 0);
    if (end == WaitEnd::Broken) {
        timeline_.fail(SLUICE_ERROR_INVALID_ARGUMENT);
    }
    if (end != WaitEnd::Reached) {
        return;
    }
    // Value by value, as in one process: docs/validation.md tells what a layer makes of a leap.
    for (const std::uint64_t target = timeline_.value(SLUICE_HOST_TO_RENDERER); forwarded_ < target;) {
        ++forwarded_;
        if (const SluiceResult result = api_.timeline_signal(renderer_, forwarded_); result != SLUICE_OK) {
            timeline_.fail(result);
            return;
        }
    }
}

void Carriers::promise(const Promise& promise) {
    {
        const std::lock_guard lock(mutex_);
        promises_.push_back(promise);
    }
    promised_.notify_one();
}

void Carriers::publishReached() {
    const std::lock_guard lock(publish_mutex_);
    std::uint64_t value = 0;
    if (api_.timeline_value(renderer_, SLUICE_RENDERER_TO_HOST, &value) == SLUICE_OK && value > published_) {
        published_ = value;
        (void)timeline_.publish(SLUICE_RENDERER_TO_HOST, value);
    }
}

void Carriers::carryHost() {
    std::uint64_t next = 1;
    while (!stop_) {
        switch (timeline_.wait(SLUICE_HOST_TO_RENDERER, next, kSliceNs)) {
            case WaitEnd::Reached:
                forward();
                next = timeline_.value(SLUICE_HOST_TO_RENDERER) + 1;
                break;
            case WaitEnd::Timeout:
                break;
            case WaitEnd::Broken:
                timeline_.fail(SLUICE_ERROR_INVALID_ARGUMENT);
                return;
            case WaitEnd::PeerDead:
            case WaitEnd::Failed:
                return;
        }
    }
}

bool Carriers::reached(const Promise& promise) {
    // The renderer cannot be there before the host, so nothing is lost, and this thread is not inside timeline_wait
    // while the other is inside timeline_signal for the same frame (docs/validation.md).
    while (promise.wait_value != 0) {
        const WaitEnd end = timeline_.wait(SLUICE_HOST_TO_RENDERER, promise.wait_value, kSliceNs);
        if (end == WaitEnd::Reached) {
            forward();
            break;
        }
        if (stop_ || end != WaitEnd::Timeout) {
            return false;
        }
    }
    while (!stop_) {
        const SluiceResult result = api_.timeline_wait(renderer_, promise.signal_value, kSliceNs);
        if (result == SLUICE_OK) {
            return true;
        }
        if (result != SLUICE_TIMEOUT) {
            timeline_.fail(result);
            return false;
        }
    }
    return false;
}

void Carriers::carryRenderer() {
    for (;;) {
        Promise promise{};
        {
            std::unique_lock lock(mutex_);
            promised_.wait(lock, [this] { return stop_ || !promises_.empty(); });
            if (stop_) {
                return;
            }
            promise = promises_.front();
            promises_.pop_front();
        }
        if (reached(promise)) {
            dieIfAsked(hello_, promise.signal_value, false);
            publishReached();
        }
    }
}

}  // namespace sluice::isolate
