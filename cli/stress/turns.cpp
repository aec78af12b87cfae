// SPDX-License-Identifier: MIT
// The hand-offs themselves: waits, turns and signals of both sides, and what a fault makes of them.
#include <fmt/format.h>

#include <algorithm>

#include "sluice/trace.hpp"
#include "stress/runner.hpp"

namespace sluice::stress {

using ledger::EventKind;

namespace {

constexpr std::uint64_t kDeadlineNs = 10'000'000'000;   ///< of each hand-off
constexpr std::uint64_t kDropDeadlineNs = 250'000'000;  ///< of a wait for what a lost signal keeps back

}  // namespace

void Runner::touches(ledger::ActorId by, const Turn& turn, std::uint32_t wrong_layout) {
    const std::uint32_t shared = course_.slots().shared();
    // OpenGL has images in one layout for good; buffers have none.
    std::vector<std::uint32_t> transferred;
    if (by == kQueue && row_.combination.resource != Resource::Buffer) {
        transferred = turn.inputs;
        transferred.push_back(turn.output);
        std::erase_if(transferred, [shared](std::uint32_t slot) { return slot >= shared; });
    }
    const auto layouts = [](std::uint32_t from) { return std::uint64_t{kSharedLayout} << 32U | from; };
    for (const std::uint32_t slot : transferred) {
        book_.event(EventKind::Acquire, by, slot, layouts(slot == wrong_layout ? kWrongLayout : kSharedLayout),
                    ledger::kNoActor);
    }
    for (std::size_t j = 0; j < turn.inputs.size(); ++j) {
        if (turn.inputs[j] < shared) {
            book_.event(EventKind::Read, by, turn.inputs[j], turn.input_versions[j]);
        }
    }
    if (turn.output < shared) {
        book_.event(EventKind::Write, by, turn.output, turn.version);
    }
    for (const std::uint32_t slot : transferred) {
        book_.event(EventKind::Release, by, slot, layouts(kSharedLayout), ledger::kNoActor);
    }
}

/// The first shared slot that a turn touches.
std::uint32_t Runner::firstShared(const Turn& turn) const {
    const std::uint32_t shared = course_.slots().shared();
    const auto input =
        std::find_if(turn.inputs.begin(), turn.inputs.end(), [shared](std::uint32_t slot) { return slot < shared; });
    return input != turn.inputs.end() ? *input : turn.output;
}

Signals Runner::signals() {
    // First: all drops up to there have then been counted.
    const std::uint64_t past = rig_.link().past();
    return {promised_, past, to_drop_, rig_.link().dropped(), rescued_};
}

/// Waits for a renderer-to-host value as the host does. Only once a signal is really lost the wait ends early and in
/// vain; then the signal is given in its place, as a watchdog would. However slow the machine, nothing else does that.
Status Runner::wait(std::uint64_t value) {
    std::uint64_t begin = monotonicNanoseconds();
    for (;;) {
        const Signals before = signals();
        const bool lost = signalLost(before);
        const Status status =
            rig_.gl().timeline().wait(value, dropUnderWay(before) ? kDropDeadlineNs : kDeadlineNs, {});
        if (status || status.error().code != SLUICE_TIMEOUT) {
            return status;
        }
        const std::uint64_t waited = monotonicNanoseconds() - begin;
        if (!lost && waited < kDeadlineNs) {
            continue;
        }
        book_.event(EventKind::Wait, kHost, course_.slots().shape.relay ? kToGl : kToHost, value, 0, ledger::kTimedOut,
                    waited);
        if (!lost) {
            row_.chain = book_.waitChain(kQueue);
            return Error{SLUICE_TIMEOUT, fmt::format("hand-off {}", row_.handoffs),
                         fmt::format("the host waited in vain for renderer-to-host value {} for {:.2f} s", value,
                                     static_cast<double>(waited) * 1e-9),
                         "the chain below says who waits for whom"};
        }
        rescued_ = promised_;
        if (Status rescued = rig_.link().rescue(rescued_); !rescued) {
            return rescued;
        }
        begin = monotonicNanoseconds();
    }
}

Status Runner::glWait(const Round& round) {
    if (round.gl_wait == 0) {
        return {};
    }
    ++row_.handoffs;
    std::uint64_t value = round.gl_wait;
    if (misses(round, Side::Gl)) {
        value = fault_.kind == Fault::WrongValue ? last_gl_wait_ : 0;
    } else {
        last_gl_wait_ = value;
    }
    return value == 0 ? Status{} : wait(value);
}

Status Runner::glTurn(const Round& round) {
    book_.event(EventKind::Frame, kHost, ledger::kNoObject, round.frame);
    book_.event(EventKind::Frame, kGl, ledger::kNoObject, round.frame);
    if (Status status = glWait(round); !status) {
        return status;
    }
    book_.submit(kHost, kGl);
    touches(kGl, round.gl);
    rig_.gl().run(round.gl);
    const bool drop = fault_.kind == Fault::Drop && round.number >= fault_.round &&
                      round.number < fault_.round + course_.slots().shape.sets;
    const bool other = (fault_.kind == Fault::Delay || fault_.kind == Fault::Duplicate) && round.number == fault_.round;
    if (drop || other) {
        rig_.link().arm(fault_.kind, round.gl_signal, fault_.delay_us);
        to_drop_ = drop ? round.gl_signal : to_drop_;
    }
    if (fault_.kind == Fault::Swap && (round.number == fault_.round || round.number == fault_.round + 1)) {
        const std::uint64_t given = round.number == fault_.round ? next_signal_ : swapped_;
        swapped_ = round.gl_signal;
        rig_.link().arm(fault_.kind, round.gl_signal, 0, given);
    }
    book_.fence(round.gl_signal);
    rig_.link().expectSignal(round.gl_signal);
    promised_ = round.gl_signal;
    if (Status status = rig_.gl().timeline().signal(round.gl_signal, {}); !status) {
        return status;
    }
    if (fault_.kind == Fault::EarlyReuse && faultHere(round, Side::Gl)) {
        const Turn again = course_.scribble(round.gl.output);
        book_.submit(kHost, kGl);
        touches(kGl, again);
        rig_.gl().run(again);
    }
    return {};
}

/// With finish the host waits for the queue after each submission; that would do what a wait which is left out on
/// purpose does not.
bool Runner::idleWouldHide(const Round& round) const {
    return (fault_.kind == Fault::SkipWait || fault_.kind == Fault::WrongValue) && fault_.side == Side::Gl &&
           round.number + course_.slots().shape.sets >= fault_.round && round.number <= fault_.round;
}

Status Runner::vulkanTurns(const Round& round) {
    book_.event(EventKind::Frame, kQueue, ledger::kNoObject, round.frame);
    for (std::size_t j = 0; j < round.vulkan.size(); ++j) {
        const Turn& turn = round.vulkan[j];
        Hand hand = round.hands[j];
        row_.handoffs += hand.waits ? 1U : 0U;
        // One of a fan is enough, and the last is the one whose wait nothing else implies less or more than the
        // others'.
        if (misses(round, Side::Vulkan)) {
            hand.wait = fault_.kind == Fault::WrongValue ? last_vulkan_wait_ : 0;
            hand.waits = hand.wait != 0;
        }
        book_.submit(kHost, kQueue);
        if (hand.waits) {
            book_.event(EventKind::Wait, kQueue, kToRenderer, hand.wait);
        }
        if (fault_.kind == Fault::WrongLayout && faultHere(round, Side::Vulkan) && j == 0) {
            hand.wrong_layout = firstShared(turn);
        }
        touches(kQueue, turn, hand.wrong_layout);
        book_.event(EventKind::Signal, kQueue, kToHost, hand.signal);
        rig_.link().expectBack(hand.signal);
        if (Status status = rig_.vulkan().submit(turn, hand); !status) {
            return status;
        }
    }
    if (!round.hands.empty() && !misses(round, Side::Vulkan)) {
        last_vulkan_wait_ = round.hands.front().wait;
    }
    if (fault_.kind == Fault::EarlyReuse && faultHere(round, Side::Vulkan)) {
        const Turn again = course_.scribble(round.vulkan.back().output);
        book_.submit(kHost, kQueue);
        touches(kQueue, again);
        if (Status status = rig_.vulkan().submit(again, {false, 0, 0, kNoSlot}); !status) {
            return status;
        }
    }
    if (row_.combination.backend == Backend::Finish && !idleWouldHide(round)) {
        return wait(round.hands.back().signal);
    }
    return {};
}

Status Runner::rounds(const Epoch& epoch, std::uint32_t count, const std::function<bool()>& stop) {
    const Pattern pattern = row_.combination.pattern;
    const std::uint32_t batch = pattern == Pattern::WaitBeforeSignal ? course_.slots().shape.sets : 1;
    for (std::uint32_t done = 0; done < count && !stop(); done += batch) {
        std::vector<Round> planned;
        for (std::uint32_t i = 0; i < std::min(batch, count - done); ++i) {
            planned.push_back(course_.next(done + i));
        }
        // What the fault's partner will signal: it may be of the next batch.
        const std::uint32_t after_batch = done + static_cast<std::uint32_t>(planned.size());
        for (std::size_t i = 0; i < planned.size(); ++i) {
            if (epoch.fault.kind == Fault::Swap && planned[i].number == epoch.fault.round) {
                next_signal_ =
                    i + 1 < planned.size() ? planned[i + 1].gl_signal : Course(course_).next(after_batch).gl_signal;
            }
        }
        const bool vulkan_first = pattern == Pattern::WaitBeforeSignal || pattern == Pattern::VkToGl;
        for (const bool vulkan : {vulkan_first, !vulkan_first}) {
            for (const Round& round : planned) {
                if (Status status = vulkan ? vulkanTurns(round) : glTurn(round); !status) {
                    return status;
                }
            }
        }
        fault_is_due_ |= epoch.fault.kind != Fault::None && done + batch > epoch.fault.round;
    }
    return {};
}

/// Until nothing is under way any more.
Status Runner::settle() {
    if (course_.lastRenderer() != 0) {
        if (Status status = wait(course_.lastRenderer()); !status) {
            return status;
        }
    }
    if (course_.lastHost() > rescued_ && !rig_.link().settled(course_.lastHost(), kDeadlineNs)) {
        return Error{SLUICE_TIMEOUT, fmt::format("hand-off {}", row_.handoffs),
                     fmt::format("the bridge did not signal host-to-renderer value {} within 10 s", course_.lastHost()),
                     ""};
    }
    return {};
}

}  // namespace sluice::stress
