// SPDX-License-Identifier: MIT
#include "frame/call_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "sluice/blocked_signals.hpp"
#include "sluice/trace.hpp"

namespace sluice::host {

namespace {

std::string whatEndsIt(std::uint64_t limit_ns, std::uint64_t spent_ns) {
    if (limit_ns == 0) {
        return "a call inside this process cannot be ended, one in a process of its own can (sluice render --isolate)";
    }
    return fmt::format("its process is killed in {:.1f} s",
                       static_cast<double>(limit_ns - std::min(limit_ns, spent_ns)) * 1e-9);
}

}  // namespace

CallWatch::CallWatch(std::uint64_t patience_ns, Log log, CallLimits limits)
    : patience_ns_(patience_ns), log_(std::move(log)), limits_(limits) {
    if (patience_ns_ != 0) {
        const BlockedSignals quiet;
        thread_ = std::thread([this] { run(); });
    }
}

CallWatch::~CallWatch() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_one();
    if (thread_.joinable()) {
        thread_.join();
    }
}

CallWatch::Scope::Scope(CallWatch& watch, const char* call, std::uint64_t frame, std::uint64_t more_ns)
    : watch_(watch) {
    if (watch_.patience_ns_ == 0) {
        return;
    }
    const std::lock_guard lock(watch_.mutex_);
    watch_.call_ = call;
    watch_.frame_ = frame;
    watch_.begin_ns_ = monotonicNanoseconds();
    watch_.late_ns_ = watch_.begin_ns_ + watch_.patience_ns_ + more_ns;
}

CallWatch::Scope::~Scope() {
    const std::lock_guard lock(watch_.mutex_);
    watch_.call_ = nullptr;
}

void CallWatch::run() {
    // Looking now and then costs the calls no wake-up each; a call is told of half its patience late at most.
    const std::chrono::nanoseconds interval(std::max<std::uint64_t>(patience_ns_ / 2, 1'000'000));
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, interval, [this] { return stop_; })) {
        const std::uint64_t now = monotonicNanoseconds();
        if (call_ == nullptr || now < late_ns_) {
            continue;
        }
        const char* call = std::exchange(call_, nullptr);
        const std::uint64_t frame = frame_;
        const std::uint64_t spent = now - begin_ns_;
        const std::uint64_t limit = frame != 0 ? limits_.frame_call_ns : limits_.call_ns;
        lock.unlock();
        try {
            if (log_) {
                log_(SLUICE_LOG_WARNING,
                     fmt::format("watchdog: the renderer has not come back from {}{} for {:.1f} s, and the host's "
                                 "frame waits for it; {}",
                                 call, frame != 0 ? fmt::format(" of frame {}", frame) : std::string(),
                                 static_cast<double>(spent) * 1e-9, whatEndsIt(limit, spent)));
            }
        } catch (const std::exception&) {
            // Without memory there is no line; the call is no later for it.
        }
        lock.lock();
    }
}

}  // namespace sluice::host
