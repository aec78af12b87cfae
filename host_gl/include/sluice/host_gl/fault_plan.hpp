// SPDX-License-Identifier: MIT
// One mistake in the order of a hand-off, made on purpose.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

/// Everything but SkipWait of HOST_TO_RENDERER and of SIMULATION_TO_RENDERER, which the renderer leaves out, is done on
/// the host's side.
enum class FaultKind : std::uint8_t {
    Drop,           ///< the signal is never given; RENDERER_TO_HOST: the host never sees it
    Delay,          ///< it comes late
    Duplicate,      ///< it is given twice
    Swap,           ///< it changes places with the host's next
    WrongValue,     ///< another value is signalled, or waited for
    SkipWait,       ///< the wait is left out
    EarlyReuse,     ///< the composite is left out, and so is the wait before the set is captured into again
    KillRenderer,   ///< an isolated renderer is killed (SIGKILL) when it is to tell that the frame is done
    CrashRenderer,  ///< it crashes (SIGSEGV) inside submit_frame, with the frame on its queue
    StopRenderer,   ///< it is stopped (SIGSTOP) there, and submit_frame never comes back
};
inline constexpr std::array<std::pair<std::string_view, FaultKind>, 10> kFaultNames{
    {{"drop", FaultKind::Drop},
     {"delay", FaultKind::Delay},
     {"duplicate", FaultKind::Duplicate},
     {"swap", FaultKind::Swap},
     {"wrong-value", FaultKind::WrongValue},
     {"skip-wait", FaultKind::SkipWait},
     {"early-reuse", FaultKind::EarlyReuse},
     {"kill-renderer", FaultKind::KillRenderer},
     {"crash-renderer", FaultKind::CrashRenderer},
     {"stop-renderer", FaultKind::StopRenderer}}};

struct FaultPlan {
    FaultKind kind{};
    std::uint64_t frame = 0;
    SluiceDirection direction = SLUICE_HOST_TO_RENDERER;
    /// Delay: milliseconds. WrongValue: the value, 0 for the next frame's (HOST_TO_RENDERER) or the last one's.
    std::uint64_t value = 0;
};

/// A fault of the renderer's process: IsolationConfig takes it, FluidHostConfig does not.
[[nodiscard]] constexpr bool ofProcess(FaultKind kind) {
    return kind == FaultKind::KillRenderer || kind == FaultKind::CrashRenderer || kind == FaultKind::StopRenderer;
}

/// Duplicate and Swap are about signals, and the renderer's are its own; EarlyReuse is about the host's wait.
[[nodiscard]] constexpr bool possible(FaultKind kind, SluiceDirection direction) {
    if (direction == SLUICE_SIMULATION_TO_RENDERER) {
        return kind == FaultKind::SkipWait;
    }
    return direction == SLUICE_HOST_TO_RENDERER
               ? kind != FaultKind::EarlyReuse
               : kind != FaultKind::Duplicate && kind != FaultKind::Swap && !ofProcess(kind);
}

/// Refuses what would hang on `timeline`: where OpenGL itself waits (NATIVE, BINARY), nothing ends a wait for a
/// renderer that never gets its signal.
[[nodiscard]] Status checkFault(const FaultPlan& plan, SluiceTimelineKind timeline);

}  // namespace sluice::host
