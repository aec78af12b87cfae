// SPDX-License-Identifier: MIT
#include "timeline/faulty.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "sluice/format.hpp"
#include "sluice/trace.hpp"
#include "timeline/cpu_wait.hpp"

namespace sluice::host {

namespace {

std::string_view nameOf(FaultKind kind) {
    const auto* found =
        std::find_if(kFaultNames.begin(), kFaultNames.end(), [&](const auto& one) { return one.second == kind; });
    return found->first;
}

void sleepUntil(std::uint64_t monotonic_ns) {
    const std::uint64_t now = monotonicNanoseconds();
    if (monotonic_ns > now) {
        std::this_thread::sleep_for(std::chrono::nanoseconds(monotonic_ns - now));
    }
}

class FaultyTimeline final : public HostTimeline {
  public:
    FaultyTimeline(std::unique_ptr<HostTimeline> inner, const FaultPlan& plan, TimelineDeps deps)
        : deps_(std::move(deps)), inner_(std::move(inner)), plan_(plan) {}
    FaultyTimeline(const FaultyTimeline&) = delete;
    FaultyTimeline& operator=(const FaultyTimeline&) = delete;
    ~FaultyTimeline() override {
        (void)giveLate();
        if (last_ < plan_.frame && deps_.log) {
            deps_.log(SLUICE_LOG_WARNING, fmt::format("fault {}: frame {} never came, the last one was {}: nothing was "
                                                      "injected",
                                                      nameOf(plan_.kind), plan_.frame, last_));
        }
    }

    [[nodiscard]] SluiceTimelineKind kind() const override { return inner_->kind(); }

    [[nodiscard]] Status signal(std::uint64_t value, std::span<const std::uint32_t> textures) override {
        last_ = std::max(last_, (value + 1) / 2);
        if (Status status = giveLate(); !status) {
            return status;
        }
        if (!aims(SLUICE_HOST_TO_RENDERER)) {
            return inner_->signal(value, textures);
        }
        const bool first = value == gbufferWritten(plan_.frame);
        if (plan_.kind == FaultKind::Swap && value == compositeRead(plan_.frame)) {
            return inner_->signal(gbufferWritten(plan_.frame), textures);
        }
        return first ? signalWrongly(value, textures) : inner_->signal(value, textures);
    }

    [[nodiscard]] Status wait(std::uint64_t value, std::uint64_t timeout_ns,
                              std::span<const std::uint32_t> textures) override {
        const std::uint64_t begin = monotonicNanoseconds();
        const std::uint64_t deadline = begin + timeout_ns;
        if (late_) {
            sleepUntil(std::min(late_->due, deadline));
            if (late_->due > deadline) {
                return inVain(value, begin);
            }
            if (Status status = giveLate(); !status) {
                return status;
            }
        }
        const std::uint64_t now = monotonicNanoseconds();
        const std::uint64_t left = deadline - std::min(now, deadline);
        if (!aims(SLUICE_RENDERER_TO_HOST) || value != fluidWritten(plan_.frame)) {
            return inner_->wait(value, left, textures);
        }
        switch (plan_.kind) {
            case FaultKind::SkipWait:
                return {};
            case FaultKind::Drop:
                // Only this value is lost: whoever asks again, for it or a higher one, sees the counter.
                if (std::exchange(spent_, true)) {
                    return inner_->wait(value, left, textures);
                }
                sleepUntil(deadline);
                return inVain(value, begin);
            case FaultKind::Delay: {
                const std::uint64_t due = begin + plan_.value * 1'000'000;
                sleepUntil(std::min(due, deadline));
                return due > deadline ? inVain(value, begin)
                                      : inner_->wait(value, deadline - std::min(due, deadline), textures);
            }
            case FaultKind::WrongValue: {
                const std::uint64_t wrong = plan_.value != 0 ? plan_.value : value - 1;
                return wrong == 0 ? Status{} : inner_->wait(wrong, left, textures);
            }
            case FaultKind::EarlyReuse:
                if (std::exchange(spent_, true)) {
                    return {};
                }
                return Error{SLUICE_TIMEOUT, "injected fault",
                             fmt::format("the composite of frame {} is left out", plan_.frame), ""};
            case FaultKind::Duplicate:
            case FaultKind::Swap:
            case FaultKind::KillRenderer:
            case FaultKind::CrashRenderer:
            case FaultKind::StopRenderer:
                break;
        }
        return inner_->wait(value, left, textures);
    }

  private:
    struct Late {
        std::uint64_t value;
        std::vector<std::uint32_t> textures;
        std::uint64_t due;
    };

    [[nodiscard]] bool aims(SluiceDirection direction) const { return plan_.direction == direction; }

    [[nodiscard]] Status giveLate() {
        const std::optional<Late> late = std::exchange(late_, std::nullopt);
        return late ? inner_->signal(late->value, late->textures) : Status{};
    }

    [[nodiscard]] Status signalWrongly(std::uint64_t value, std::span<const std::uint32_t> textures) {
        switch (plan_.kind) {
            case FaultKind::Drop:
                return {};
            case FaultKind::Delay:
                late_ =
                    Late{value, {textures.begin(), textures.end()}, monotonicNanoseconds() + plan_.value * 1'000'000};
                return {};
            case FaultKind::Duplicate: {
                Status status = inner_->signal(value, textures);
                // A backend that refuses the second one has done what is right; the frame goes on.
                (void)inner_->signal(value, textures);
                return status;
            }
            case FaultKind::Swap:
                return inner_->signal(compositeRead(plan_.frame), textures);
            case FaultKind::WrongValue:
                return inner_->signal(plan_.value != 0 ? plan_.value : gbufferWritten(plan_.frame + 1), textures);
            case FaultKind::SkipWait:  // the renderer's: FluidHost asks it to
            case FaultKind::EarlyReuse:
            case FaultKind::KillRenderer:
            case FaultKind::CrashRenderer:
            case FaultKind::StopRenderer:
                break;
        }
        return inner_->signal(value, textures);
    }

    [[nodiscard]] Status inVain(std::uint64_t value, std::uint64_t begin_ns) const {
        if (deps_.feed != nullptr) {
            deps_.feed->hostWaits(value);
        }
        tellWatchdog(deps_, value, begin_ns);
        return Error{SLUICE_TIMEOUT, "renderer's timeline",
                     fmt::format("did not reach {} in time: an injected fault", value), ""};
    }

    TimelineDeps deps_;
    std::unique_ptr<HostTimeline> inner_;
    FaultPlan plan_;
    std::optional<Late> late_;
    bool spent_ = false;
    std::uint64_t last_ = 0;  ///< frame
};

}  // namespace

Status checkFault(const FaultPlan& plan, SluiceTimelineKind timeline) {
    if (ofProcess(plan.kind)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("fault {}", nameOf(plan.kind)),
                     "the renderer runs in this process, which would die with it", "isolate the renderer"};
    }
    const bool gl_waits = timeline == SLUICE_TIMELINE_NATIVE || timeline == SLUICE_TIMELINE_BINARY;
    const bool starves =
        plan.kind == FaultKind::Drop || plan.kind == FaultKind::Swap || plan.kind == FaultKind::Duplicate;
    if (gl_waits && starves && plan.direction == SLUICE_HOST_TO_RENDERER) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("fault {} to the renderer", nameOf(plan.kind)),
                     fmt::format("with timeline {} OpenGL would wait without an end", toString(timeline)),
                     "use --timeline bridged"};
    }
    return {};
}

std::unique_ptr<HostTimeline> makeFaultyTimeline(std::unique_ptr<HostTimeline> inner, const FaultPlan& plan,
                                                 const TimelineDeps& deps) {
    return std::make_unique<FaultyTimeline>(std::move(inner), plan, deps);
}

}  // namespace sluice::host
