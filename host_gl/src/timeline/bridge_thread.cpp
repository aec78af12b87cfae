// SPDX-License-Identifier: MIT
#include "timeline/bridge_thread.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "context/profile.hpp"
#include "sluice/blocked_signals.hpp"
#include "timeline/cpu_wait.hpp"
#include "timeline/timeline_events.hpp"

namespace sluice::host {

namespace {

// Bounds how late a stopping thread notices its deadline.
constexpr std::uint64_t kSliceNs = 50'000'000;

}  // namespace

BridgeThread::BridgeThread(BridgeContext context, TimelineDeps deps)
    : context_(std::move(context)), deps_(std::move(deps)) {}

Result<std::unique_ptr<BridgeThread>> BridgeThread::start(BridgeContext context, const TimelineDeps& deps) {
    std::unique_ptr<BridgeThread> bridge(new BridgeThread(std::move(context), deps));
    {
        const BlockedSignals quiet;
        bridge->thread_ = std::thread([raw = bridge.get()] { raw->run(); });
    }
    std::unique_lock lock(bridge->mutex_);
    bridge->started_.wait(lock, [&] { return bridge->start_.has_value(); });
    const Status status = *bridge->start_;
    lock.unlock();
    if (!status) {
        return status.error();
    }
    return bridge;
}

BridgeThread::~BridgeThread() {
    deadline_ = monotonicNanoseconds() + deps_.drain_timeout_ns;
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_one();
    if (thread_.joinable()) {
        thread_.join();
    }
    // What a thread that never got its context has left behind.
    for (const Promise& promise : promises_) {
        if (!glGone()) {
            glDeleteSync(promise.fence);
        }
    }
    if (error_ && deps_.log) {
        // A lost renderer has been told of where it was noticed; that it takes no values then is no news.
        deps_.log(error_->code == SLUICE_ERROR_DEVICE_LOST ? SLUICE_LOG_INFO : SLUICE_LOG_WARNING, error_->message());
    }
}

void BridgeThread::promise(GLsync fence, std::uint64_t value) {
    {
        const std::lock_guard lock(mutex_);
        promises_.push_back({fence, value});
        promised_ = value;
    }
    wake_.notify_one();
}

bool BridgeThread::waitUntilKept(std::uint64_t value, std::uint64_t timeout_ns) {
    std::unique_lock lock(mutex_);
    const std::uint64_t last = std::min(value, promised_);
    return kept_changed_.wait_for(lock, std::chrono::nanoseconds(timeout_ns), [&] {
        return kept_ >= last || error_.has_value();
    }) && !error_.has_value();
}

std::optional<Error> BridgeThread::takeError() {
    const std::lock_guard lock(mutex_);
    failed_ = false;
    return std::exchange(error_, std::nullopt);
}

void BridgeThread::fail(const Error& error) {
    const std::lock_guard lock(mutex_);
    if (!error_) {
        error_ = error;
    }
    failed_ = true;
}

void BridgeThread::run() {
    const Status current = context_.makeCurrent();
    {
        const std::lock_guard lock(mutex_);
        start_ = current;
    }
    started_.notify_one();
    if (!current) {
        return;
    }
    for (;;) {
        const std::uint64_t idle = traceClock(deps_.trace, deps_.feed);
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [this] { return stop_ || !promises_.empty(); });
        if (promises_.empty()) {
            break;
        }
        const Promise promise = promises_.front();
        promises_.pop_front();
        lock.unlock();
        keep(promise, idle);
    }
    context_.release();
}

void BridgeThread::keep(const Promise& promise, std::uint64_t idle_ns) {
    const std::uint64_t begin = traceClock(deps_.trace, deps_.feed);
    const Status arrived = waitForFence(promise);
    traceStep(deps_.trace, SLUICE_TRACE_MARK, SLUICE_TRACK_BRIDGE, SLUICE_HOST_TO_RENDERER, promise.value, begin,
              "wait for GL fence");
    glDeleteSync(promise.fence);
    if (deps_.feed != nullptr) {
        deps_.feed->bridgeWaited(promise.value, idle_ns, begin, arrived.ok());
    }
    if (!arrived) {
        fail(arrived.error());
    }
    if (const Status signalled = signalFromCpu(deps_, promise.value, SLUICE_TRACK_BRIDGE); !signalled) {
        fail(signalled.error());
    }
    {
        const std::lock_guard lock(mutex_);
        kept_ = promise.value;
    }
    kept_changed_.notify_all();
}

Status BridgeThread::waitForFence(const Promise& promise) const {
    for (;;) {
        const GLenum result = glClientWaitSync(promise.fence, 0, kSliceNs);
        if (result == GL_ALREADY_SIGNALED || result == GL_CONDITION_SATISFIED) {
            return {};
        }
        if (result == GL_WAIT_FAILED) {
            return Error{SLUICE_ERROR_DEVICE_LOST, "bridged timeline",
                         fmt::format("waiting for the GL fence of value {} failed", promise.value),
                         "the GL context may be lost; the renderer was let go on without it"};
        }
        const std::uint64_t deadline = deadline_;
        if (deadline != 0 && monotonicNanoseconds() >= deadline) {
            return Error{
                SLUICE_TIMEOUT, "bridged timeline",
                fmt::format("the GL fence of value {} had not arrived when the bridge was closed", promise.value),
                "the renderer was let go on without it"};
        }
    }
}

}  // namespace sluice::host
