// SPDX-License-Identifier: MIT
#include "sluice/isolate/shared_timeline.hpp"

#include <fmt/format.h>
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <ctime>
#include <new>
#include <utility>

#include "sluice/trace.hpp"

namespace sluice::isolate {

namespace {

/// How often a waiter looks for itself: the other process can write the futex word as it likes, so a wake may be lost.
constexpr std::uint64_t kSliceNs = 100'000'000;
/// A counter moves by one or two a frame. More than that at once is not a late look but a broken writer.
constexpr std::uint64_t kLargestLeap = 1U << 20U;

void futexWait(std::atomic<std::uint32_t>& word, std::uint32_t seen, std::uint64_t timeout_ns) {
    timespec time{};
    time.tv_sec = static_cast<time_t>(timeout_ns / 1'000'000'000);
    time.tv_nsec = static_cast<long>(timeout_ns % 1'000'000'000);
    // Not FUTEX_PRIVATE: the other process sleeps on and wakes the same word. Whatever ends it, the caller looks again.
    (void)::syscall(SYS_futex, &word, FUTEX_WAIT, seen, &time, nullptr, 0);
}

void futexWake(std::atomic<std::uint32_t>& word) {
    word.fetch_add(1);
    (void)::syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

}  // namespace

SharedTimeline::SharedTimeline(UniqueFd fd, Mapping mapping)
    : fd_(std::move(fd)), mapping_(std::move(mapping)), page_(static_cast<Page*>(mapping_.at())) {}

Result<std::unique_ptr<SharedTimeline>> SharedTimeline::create() {
    Result<UniqueFd> page = sharedPage(sizeof(Page));
    if (!page) {
        return page.error();
    }
    Result<std::unique_ptr<SharedTimeline>> timeline = adopt(std::move(page).value());
    if (timeline) {
        new (timeline.value()->page_) Page{};
    }
    return timeline;
}

Result<std::unique_ptr<SharedTimeline>> SharedTimeline::adopt(UniqueFd fd) {
    Result<Mapping> mapping = mapShared(fd, sizeof(Page));
    if (!mapping) {
        return mapping.error();
    }
    return std::unique_ptr<SharedTimeline>(new SharedTimeline(std::move(fd), std::move(mapping).value()));
}

Status SharedTimeline::publish(SluiceDirection direction, std::uint64_t value) {
    {
        const std::lock_guard lock(mutex_);
        std::uint64_t& highest = highest_.at(direction);
        if (value <= highest) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, "shared timeline",
                         fmt::format("{} was to be signalled, the counter is already at {}", value, highest),
                         "values only ever increase"};
        }
        highest = value;
        word(direction).value.store(value);
    }
    futexWake(word(direction).sequence);
    return {};
}

std::uint64_t SharedTimeline::value(SluiceDirection direction) const {
    return word(direction).value.load();
}

bool SharedTimeline::look(SluiceDirection direction, std::uint64_t& value) {
    const std::lock_guard lock(mutex_);
    value = word(direction).value.load();
    std::uint64_t& highest = highest_.at(direction);
    if (value < highest || value - highest > kLargestLeap) {
        return false;
    }
    highest = value;
    return true;
}

WaitEnd SharedTimeline::wait(SluiceDirection direction, std::uint64_t value, std::uint64_t timeout_ns) {
    const std::uint64_t begin = monotonicNanoseconds();
    for (;;) {
        // Read before the conditions, so that a change after them makes the futex return at once.
        const std::uint32_t sequence = word(direction).sequence.load();
        const bool dead = dead_;
        std::uint64_t now = 0;
        if (!look(direction, now)) {
            return WaitEnd::Broken;
        }
        if (now >= value) {
            return WaitEnd::Reached;
        }
        if (dead) {
            return WaitEnd::PeerDead;
        }
        if (failure() != SLUICE_OK) {
            return WaitEnd::Failed;
        }
        const std::uint64_t spent = monotonicNanoseconds() - begin;
        if (spent >= timeout_ns) {
            return WaitEnd::Timeout;
        }
        futexWait(word(direction).sequence, sequence, std::min(timeout_ns - spent, kSliceNs));
    }
}

void SharedTimeline::wake() {
    futexWake(word(SLUICE_HOST_TO_RENDERER).sequence);
    futexWake(word(SLUICE_RENDERER_TO_HOST).sequence);
}

void SharedTimeline::fail(SluiceResult code) {
    page_->failure.store(code);
    wake();
}

SluiceResult SharedTimeline::failure() const {
    const std::int32_t code = page_->failure.load();
    if (code == SLUICE_OK) {
        return SLUICE_OK;
    }
    // The other process wrote it; whatever else it may be, it is no success.
    return code < SLUICE_OK && code >= SLUICE_ERROR_INTERNAL ? static_cast<SluiceResult>(code) : SLUICE_ERROR_INTERNAL;
}

void SharedTimeline::peerDied() {
    dead_ = true;
    wake();
}

}  // namespace sluice::isolate
