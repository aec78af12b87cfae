// SPDX-License-Identifier: MIT
#include "stress/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "stress/descriptors.hpp"
#include "stress/runner.hpp"
#include "stress/verdict.hpp"

namespace sluice::stress {

using ledger::EventKind;
using Clock = std::chrono::steady_clock;

namespace {

constexpr std::uint64_t kDrainNs = 2'000'000'000;

}  // namespace

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

void Runner::judge(std::uint64_t bad_before, std::uint64_t troubles_before, std::uint64_t refused) {
    const bool pixels = row_.bad_texels > bad_before;
    const bool ledger = book_.troubles() > troubles_before;
    if (fault_is_due_) {
        ++row_.faults;
        row_.by_pixels += pixels ? 1U : 0U;
        row_.by_ledger += ledger ? 1U : 0U;
        row_.by_both += pixels && ledger ? 1U : 0U;
        row_.unseen += pixels || ledger ? 0U : 1U;
        FaultCounts& here = row_.at.at(static_cast<std::size_t>(fault_.side));
        ++here.injected;
        here.by_pixels += pixels ? 1U : 0U;
        here.by_ledger += ledger ? 1U : 0U;
        here.by_both += pixels && ledger ? 1U : 0U;
        here.unseen += pixels || ledger ? 0U : 1U;
    }
    row_.failure = whyFailed({row_.combination.fault, fault_is_due_, row_.bad_texels - bad_before,
                              book_.troubles() - troubles_before, refused});
    if (row_.failure && fault_is_due_) {
        *row_.failure += fmt::format(" (in round {} of check {})", fault_.round, row_.checks);
    }
}

Status Runner::epoch(const Epoch& epoch, std::uint64_t most_rounds, const std::function<bool()>& stop) {
    if (epoch.rebuild != Rebuild::Nothing) {
        if (Status status = rig_.build(epoch.rebuild, epoch.width, epoch.height); !status) {
            row_.refused_here = row_.handoffs == 0 && status.error().code == SLUICE_ERROR_UNSUPPORTED;
            return status;
        }
        course_.rebuilt();
        promised_ = rescued_ = to_drop_ = last_gl_wait_ = last_vulkan_wait_ = 0;
        if (Status status = countDescriptors(epoch.rebuild); !status) {
            return status;
        }
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
    const std::uint64_t refused_here = rig_.link().refused() - refused;
    row_.refused += refused_here;
    if (status) {
        judge(bad, troubles, refused_here);
    }
    return status;
}

/// What drivers open once for the whole process is there after the second build; from then on not one may be added.
Status Runner::countDescriptors(Rebuild rebuild) {
    const bool devices_too = row_.combination.pattern == Pattern::CreateDestroyStorm;
    builds_ += rebuild == Rebuild::Everything || !devices_too ? 1U : 0U;
    if (builds_ >= 2) {
        const Result<std::uint64_t> elsewhere = rig_.vulkan().descriptorsElsewhere();
        if (!elsewhere) {
            return elsewhere.error();
        }
        last_descriptors_ = openDescriptors() + elsewhere.value();
        first_descriptors_ = first_descriptors_ == 0 ? last_descriptors_ : first_descriptors_;
    }
    return {};
}

void Runner::fail(const Error& error) {
    const std::optional<Error> lost = rig_.built() ? rig_.vulkan().lost() : std::nullopt;
    row_.failure = lost ? lost->message() : error.message();  // of a process that is gone, how it went
    if (rig_.built() && !rig_.vulkan().drain(0)) {
        // The signal that never came: given now, so that the queue ends.
        (void)rig_.link().rescue(std::max(course_.lastHost(), rescued_ + 1));
        row_.stuck = !rig_.vulkan().drain(kDrainNs);
    }
}

void Runner::keepLog(const std::string& log) {
    if (const Status written = book_.writeLog(log); written) {
        row_.log = log;
    } else {
        row_.log_error = written.error().message();
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
            fail(status.error());
        }
    }
    row_.interrupted = stop();
    book_.finish();
    row_.seconds = elapsed();
    row_.findings = book_.troubles();
    row_.told = book_.told();
    if (!row_.failure && last_descriptors_ > first_descriptors_) {
        row_.failure = fmt::format("{} descriptors were open after the second build, {} after the last",
                                   first_descriptors_, last_descriptors_);
    }
    const bool clean = row_.combination.fault == Fault::None;
    if (!row_.failure && clean && row_.findings > 0) {
        row_.failure = fmt::format("{} findings of the ledger at the end", row_.findings);
    }
    if (row_.failure && !log.empty() && rig_.built()) {
        keepLog(log);
    }
    if (row_.stuck) {
        rig_.abandon();
    }
    return row_;
}

Row runCombination(const Combination& combination, std::uint64_t seed, const Limit& limit, const std::string& log,
                   const std::function<bool()>& stop) {
    return Runner(combination, seed).run(limit, log, stop);
}

}  // namespace sluice::stress
