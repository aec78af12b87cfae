// SPDX-License-Identifier: MIT
#include "stress/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "sluice/trace.hpp"
#include "stress/book.hpp"
#include "stress/plan.hpp"
#include "stress/rig.hpp"
#include "stress/round.hpp"

namespace sluice::stress {
namespace {

using ledger::EventKind;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kDeadlineNs = 10'000'000'000;   ///< of each hand-off
constexpr std::uint64_t kDropDeadlineNs = 250'000'000;  ///< where a wait is meant to end in vain
constexpr std::uint64_t kDrainNs = 2'000'000'000;
/// Descriptors that a driver may open along the way; a leak of one per rebuild is soon more.
constexpr std::uint64_t kDescriptorSlack = 4;

class Runner {
  public:
    Runner(const Combination& combination, std::uint64_t seed)
        : planner_(combination, seed),
          course_(combination.pattern, planner_.shape(), seedOf(combination, seed)),
          rig_(combination, planner_.shape(), book_) {
        row_.combination = combination;
    }
    Row run(const Limit& limit, const std::string& log, const std::function<bool()>& stop);

  private:
    [[nodiscard]] Status epoch(const Epoch& epoch, std::uint64_t most_rounds, const std::function<bool()>& stop);
    [[nodiscard]] Status rounds(const Epoch& epoch, std::uint32_t count, const std::function<bool()>& stop);
    [[nodiscard]] Status glTurn(const Round& round);
    [[nodiscard]] Status glWait(const Round& round);
    [[nodiscard]] Status vulkanTurns(const Round& round);
    [[nodiscard]] Status wait(std::uint64_t value);
    [[nodiscard]] Status settle();
    [[nodiscard]] Status check();
    void judge(std::uint64_t bad_before, std::uint64_t troubles_before);
    void touches(ledger::ActorId by, const Turn& turn);
    void countDescriptors();
    void fail(const Error& error, const std::string& log);

    [[nodiscard]] bool faultHere(const Round& round, Side side) const {
        return fault_.kind != Fault::None && fault_.side == side && round.number == fault_.round;
    }
    [[nodiscard]] bool misses(const Round& round, Side side) const {
        return faultHere(round, side) && (fault_.kind == Fault::SkipWait || fault_.kind == Fault::WrongValue);
    }
    [[nodiscard]] bool idleWouldHide(const Round& round) const;
    [[nodiscard]] std::uint64_t handoffsPerRound() const { return course_.slots().shape.fan + 1U; }

    Row row_;
    Book book_;
    Planner planner_;
    Course course_;
    Rig rig_;
    Model model_;
    PlannedFault fault_;
    std::uint64_t promised_ = 0;  // the last host-to-renderer value that OpenGL was to be followed by
    std::uint64_t rescued_ = 0;   // up to here signals were given in the place of dropped ones
    std::uint64_t last_gl_wait_ = 0, last_vulkan_wait_ = 0;
    std::uint64_t first_descriptors_ = 0, last_descriptors_ = 0;
    bool fault_is_due_ = false;
};

void Runner::touches(ledger::ActorId by, const Turn& turn) {
    const std::uint32_t shared = course_.slots().shared();
    for (std::size_t j = 0; j < turn.inputs.size(); ++j) {
        if (turn.inputs[j] < shared) {
            book_.event(EventKind::Read, by, turn.inputs[j], turn.input_versions[j]);
        }
    }
    if (turn.output < shared) {
        book_.event(EventKind::Write, by, turn.output, turn.version);
    }
}

/// Waits for a renderer-to-host value as the host does. A drop that was planned ends the wait in vain; then the signal
/// is given in its place, as a watchdog would.
Status Runner::wait(std::uint64_t value) {
    const bool drops = fault_.kind == Fault::Drop;
    const std::uint64_t begin = monotonicNanoseconds();
    Status status = rig_.gl().timeline().wait(value, drops ? kDropDeadlineNs : kDeadlineNs, {});
    if (status || status.error().code != SLUICE_TIMEOUT) {
        return status;
    }
    book_.event(EventKind::Wait, kHost, course_.slots().shape.relay ? kToGl : kToHost, value, 0, ledger::kTimedOut,
                monotonicNanoseconds() - begin);
    if (drops && rig_.link().dropped() > 0 && rescued_ < promised_) {
        rescued_ = promised_;
        if (Status rescued = rig_.link().rescue(rescued_); !rescued) {
            return rescued;
        }
        return rig_.gl().timeline().wait(value, kDeadlineNs, {});
    }
    Error error = status.error();
    error.thing = fmt::format("hand-off {}", row_.handoffs);
    error.detail = fmt::format("the host waited in vain for renderer-to-host value {} for {:.2f} s", value,
                               static_cast<double>(drops ? kDropDeadlineNs : kDeadlineNs) * 1e-9);
    error.remedy = "the chain below says who waits for whom";
    row_.chain = book_.waitChain(kQueue);
    return error;
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
        touches(kQueue, turn);
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
        if (Status status = rig_.vulkan().submit(again, {false, 0, 0}); !status) {
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

/// Reads every slot back and holds it against the model: through OpenGL what is shared or its own, through Vulkan what
/// is Vulkan's own.
Status Runner::check() {
    ++row_.checks;
    for (const Turn& turn : course_.takeTurns()) {
        model_.apply(turn);
    }
    const Slots& slots = course_.slots();
    book_.submit(kHost, kGl);
    for (std::uint32_t slot = 0; slot < slots.count(); ++slot) {
        if (course_.version(slot) == 0) {
            continue;
        }
        const bool shared = slot < slots.shared();
        const bool by_vulkan = !shared && row_.combination.pattern == Pattern::GlToVk;
        Result<std::vector<std::byte>> texels = by_vulkan ? rig_.vulkan().read(slot) : rig_.gl().read(slot);
        if (!texels) {
            return texels.error();
        }
        std::uint64_t bad = 0;
        std::uint64_t version = 0;
        const Finding found = model_.compare(slot, decode(row_.combination.resource, texels.value()), bad, version);
        row_.bad_texels += bad;
        if (!shared) {
            continue;
        }
        book_.event(EventKind::Read, kGl, slot, course_.version(slot));
        // After a fault of ours wrong texels are no evidence against the driver.
        if (found != Finding::Wrong && fault_.kind == Fault::None) {
            const auto verdict = found == Finding::Right   ? ledger::Verdict::Fresh
                                 : found == Finding::Stale ? ledger::Verdict::Stale
                                                           : ledger::Verdict::Torn;
            book_.event(EventKind::Witness, kGl, slot, version, static_cast<std::uint16_t>(verdict));
        }
    }
    // A read-back has ended when the call returns, which is as good as a fence.
    const std::uint64_t name = UINT64_MAX - row_.checks;
    book_.fence(name);
    book_.fenceArrived(kHost, name);
    return {};
}

void Runner::judge(std::uint64_t bad_before, std::uint64_t troubles_before) {
    const bool pixels = row_.bad_texels > bad_before;
    const bool ledger = book_.troubles() > troubles_before;
    if (fault_is_due_) {
        ++row_.faults;
        row_.by_pixels += pixels ? 1U : 0U;
        row_.by_ledger += ledger ? 1U : 0U;
        row_.by_both += pixels && ledger ? 1U : 0U;
        row_.unseen += pixels || ledger ? 0U : 1U;
    }
    if (row_.combination.fault == Fault::None || row_.combination.fault == Fault::Delay) {
        if (pixels || ledger) {
            row_.failure = fmt::format("{} wrong texels, {} findings of the ledger{}", row_.bad_texels - bad_before,
                                       book_.troubles() - troubles_before,
                                       pixels && !ledger   ? ": in order by the model, so suspect the driver"
                                       : ledger && !pixels ? ": the contents were right by luck"
                                                           : "");
        }
    } else if (fault_is_due_ && !pixels && !ledger) {
        row_.failure = fmt::format("the {} in round {} of check {} was seen by nobody", toString(fault_.kind),
                                   fault_.round, row_.checks);
    }
}

Status Runner::epoch(const Epoch& epoch, std::uint64_t most_rounds, const std::function<bool()>& stop) {
    if (epoch.rebuild != Rebuild::Nothing) {
        if (Status status = rig_.build(epoch.rebuild, epoch.width, epoch.height); !status) {
            row_.refused_here = row_.handoffs == 0 && status.error().code == SLUICE_ERROR_UNSUPPORTED;
            return status;
        }
        course_.rebuilt();
        promised_ = rescued_ = last_gl_wait_ = last_vulkan_wait_ = 0;
        countDescriptors();
    } else if (epoch.fresh) {
        course_.restart();
    }
    if (epoch.rebuild != Rebuild::Nothing || epoch.fresh) {
        model_.restart(row_.combination.resource, rig_.storage().texels(), course_.slots().count());
    }
    book_.checkpoint();
    fault_ = epoch.fault;
    fault_is_due_ = false;
    const std::uint64_t troubles = book_.troubles();
    const std::uint64_t bad = row_.bad_texels;
    const std::uint64_t refused = rig_.link().refused();
    const auto count = static_cast<std::uint32_t>(
        epoch.fault.kind == Fault::None ? std::min<std::uint64_t>(epoch.rounds, most_rounds) : epoch.rounds);
    Status status = rounds(epoch, count, stop);
    if (status) {
        status = settle();
    }
    if (status) {
        status = check();
    }
    row_.refused += rig_.link().refused() - refused;
    if (status) {
        judge(bad, troubles);
    }
    return status;
}

void Runner::countDescriptors() {
    last_descriptors_ = openDescriptors();
    first_descriptors_ = first_descriptors_ == 0 ? last_descriptors_ : first_descriptors_;
}

void Runner::fail(const Error& error, const std::string& log) {
    row_.failure = error.message();
    if (rig_.built() && !rig_.vulkan().drain(0)) {
        // The signal that never came: given now, so that the queue ends.
        (void)rig_.link().rescue(std::max(course_.lastHost(), rescued_ + 1));
        row_.stuck = !rig_.vulkan().drain(kDrainNs);
    }
    if (!log.empty() && rig_.built()) {
        const Status written = book_.writeLog(log);
        row_.log = written ? log : "";
    }
}

Row Runner::run(const Limit& limit, const std::string& log, const std::function<bool()>& stop) {
    const auto begin = Clock::now();
    const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    const auto enough = [&] {
        return (limit.handoffs != 0 && row_.handoffs >= limit.handoffs) ||
               (limit.seconds > 0.0 && elapsed() >= limit.seconds);
    };
    const auto ends = [&] { return stop() || (limit.seconds > 0.0 && elapsed() >= limit.seconds); };
    while (!row_.failure && !stop() && (row_.checks == 0 || !enough())) {
        const std::uint64_t left = limit.handoffs == 0 ? UINT64_MAX : limit.handoffs - row_.handoffs;
        const std::uint64_t most =
            std::max<std::uint64_t>(1, left / handoffsPerRound() + (left % handoffsPerRound() != 0));
        const Epoch next = planner_.next();
        // A fault is judged with the rounds after it, so that only an interrupt cuts them short.
        const Status status = epoch(next, most, next.fault.kind == Fault::None ? std::function<bool()>(ends) : stop);
        if (!status) {
            fail(status.error(), log);
        } else if (row_.failure && !log.empty()) {
            row_.log = book_.writeLog(log) ? log : "";
        }
    }
    row_.interrupted = stop();
    book_.finish();
    row_.seconds = elapsed();
    row_.findings = book_.troubles();
    row_.told = book_.told();
    if (!row_.failure && last_descriptors_ > first_descriptors_ + kDescriptorSlack) {
        row_.failure = fmt::format("{} descriptors were open after the first build, {} after the last",
                                   first_descriptors_, last_descriptors_);
    }
    const bool clean = row_.combination.fault == Fault::None;
    if (!row_.failure && clean && row_.findings > 0) {
        row_.failure = fmt::format("{} findings of the ledger at the end", row_.findings);
    }
    if (row_.stuck) {
        rig_.abandon();
    }
    return row_;
}

}  // namespace

Row runCombination(const Combination& combination, std::uint64_t seed, const Limit& limit, const std::string& log,
                   const std::function<bool()>& stop) {
    return Runner(combination, seed).run(limit, log, stop);
}

}  // namespace sluice::stress
