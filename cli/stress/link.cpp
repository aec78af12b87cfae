// SPDX-License-Identifier: MIT
#include "stress/link.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "sluice/trace.hpp"

namespace sluice::stress {
namespace {

using ledger::EventKind;

constexpr std::uint64_t kLookNs = 20'000'000;  ///< how soon a relay notices that it has to end

Link& linkOf(SluiceRenderer* renderer) {
    return *reinterpret_cast<Link*>(renderer);
}

}  // namespace

void Link::Post::push(std::uint64_t value) {
    {
        const std::lock_guard guard(mutex);
        values.push_back(value);
    }
    wake.notify_one();
}

void Link::Post::end() {
    {
        const std::lock_guard guard(mutex);
        stop = true;
    }
    wake.notify_one();
}

std::optional<std::uint64_t> Link::Post::pop() {
    std::unique_lock lock(mutex);
    wake.wait(lock, [this] { return stop || !values.empty(); });
    if (values.empty()) {
        return std::nullopt;
    }
    const std::uint64_t value = values.front();
    values.pop_front();
    return value;
}

bool Link::Post::ended() {
    const std::lock_guard guard(mutex);
    return stop;
}

Link::Link(VkSide& vulkan, std::shared_ptr<Book> book, bool relay)
    : vulkan_(vulkan), book_(std::move(book)), relay_(relay) {
    api_.struct_size = sizeof(api_);
    api_.name = "stress";
    api_.timeline_signal = &Link::onSignal;
    api_.timeline_wait = &Link::onWait;
    if (relay_) {
        out_thread_ = std::thread([this] { relayOut(); });
        back_thread_ = std::thread([this] { relayBack(); });
    }
}

Link::~Link() {
    out_.end();
    back_.end();
    for (std::thread* thread : {&out_thread_, &back_thread_}) {
        if (thread->joinable()) {
            thread->join();
        }
    }
}

void Link::arm(Fault fault, std::uint64_t value, std::uint32_t delay_us, std::uint64_t other) {
    const std::lock_guard guard(mutex_);
    armed_.emplace(value, Armed{fault, delay_us, other});
}

void Link::expectSignal(std::uint64_t value) {
    if (relay_) {
        out_.push(value);
    }
}

void Link::expectBack(std::uint64_t value) {
    if (relay_) {
        back_.push(value);
    }
}

SluiceResult Link::onSignal(SluiceRenderer* renderer, std::uint64_t value) {
    return linkOf(renderer).fromGl(value);
}

SluiceResult Link::onWait(SluiceRenderer* renderer, std::uint64_t value, std::uint64_t timeout_ns) {
    return linkOf(renderer).wait(value, timeout_ns);
}

SluiceResult Link::fromGl(std::uint64_t value) {
    const ledger::ActorId by = std::this_thread::get_id() == host_thread_ ? kHost : kBridge;
    book_->fenceArrived(by, value);
    if (!relay_) {
        return raise(by, value);
    }
    book_->event(EventKind::Signal, by, kFromGl, value);
    const Status status = vulkan_.relaySignal(RelayLeg::FromGl, value);
    return status ? SLUICE_OK : status.error().code;
}

SluiceResult Link::raise(ledger::ActorId by, std::uint64_t value) {
    Armed armed{Fault::None, 0, 0};
    {
        const std::lock_guard guard(mutex_);
        if (const auto found = armed_.find(value); found != armed_.end()) {
            armed = found->second;
            armed_.erase(found);
        }
    }
    Status status;
    if (armed.fault == Fault::Drop) {
        dropped_ = value;
    } else {
        if (armed.fault == Fault::Delay) {
            std::this_thread::sleep_for(std::chrono::microseconds(armed.delay_us));
        }
        const std::uint64_t given = armed.fault == Fault::Swap ? armed.other : value;
        book_->event(EventKind::Signal, by, kToRenderer, given);
        status = vulkan_.signal(given);
        if (given < value && !status) {
            ++refused_;  // the later one of a swap has come first: the guard is right
            status = Status{};
        }
        if (armed.fault == Fault::Duplicate) {
            book_->event(EventKind::Signal, by, kToRenderer, value);
            refused_ += vulkan_.signal(value) ? 0U : 1U;
        }
    }
    {
        const std::lock_guard guard(mutex_);
        raised_ = std::max(raised_, value);
    }
    changed_.notify_all();
    return status ? SLUICE_OK : status.error().code;
}

SluiceResult Link::wait(std::uint64_t value, std::uint64_t timeout_ns) {
    const std::uint64_t begin = monotonicNanoseconds();
    const SluiceResult result =
        relay_ ? vulkan_.relayWait(RelayLeg::ToGl, value, timeout_ns) : vulkan_.wait(value, timeout_ns);
    if (result == SLUICE_OK) {
        book_->event(EventKind::Wait, kHost, relay_ ? kToGl : kToHost, value, 0, 0, monotonicNanoseconds() - begin);
    }
    return result;
}

Status Link::rescue(std::uint64_t value) {
    book_->event(EventKind::Signal, kHost, kToRenderer, value, 0, ledger::kForced);
    return vulkan_.signal(value);
}

std::uint64_t Link::past() {
    const std::lock_guard guard(mutex_);
    return raised_;
}

bool Link::settled(std::uint64_t value, std::uint64_t timeout_ns) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, std::chrono::nanoseconds(timeout_ns), [&] { return raised_ >= value; })) {
        return false;
    }
    lock.unlock();
    book_->event(EventKind::Wait, kHost, kToRenderer, value);
    return true;
}

void Link::relayOut() {
    while (const std::optional<std::uint64_t> value = out_.pop()) {
        while (vulkan_.relayWait(RelayLeg::FromGl, *value, kLookNs) != SLUICE_OK) {
            if (out_.ended()) {
                return;
            }
        }
        book_->event(EventKind::Wait, kRelayOut, kFromGl, *value);
        (void)raise(kRelayOut, *value);  // what fails here is missed by the queue, and told by the wait for it
    }
}

void Link::relayBack() {
    while (const std::optional<std::uint64_t> value = back_.pop()) {
        while (vulkan_.wait(*value, kLookNs) != SLUICE_OK) {
            if (back_.ended()) {
                return;
            }
        }
        book_->event(EventKind::Wait, kRelayBack, kToHost, *value);
        book_->event(EventKind::Signal, kRelayBack, kToGl, *value);
        (void)vulkan_.relaySignal(RelayLeg::ToGl, *value);
    }
}

}  // namespace sluice::stress
