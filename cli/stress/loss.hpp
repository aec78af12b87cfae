// SPDX-License-Identifier: MIT
// When a signal counts as lost, so that a watchdog may give it. Pure.
#pragma once

#include <cstdint>

namespace sluice::stress {

/// Values of host-to-renderer; 0: none yet.
struct Signals {
    std::uint64_t promised = 0;  ///< the last that OpenGL was to be followed by
    std::uint64_t past = 0;      ///< up to here each has been given or dropped
    std::uint64_t to_drop = 0;   ///< the last that is to be dropped
    std::uint64_t dropped = 0;   ///< the last that was
    std::uint64_t rescued = 0;   ///< up to here given by the watchdog
};

/// A signal will be missed, or is: a wait has to look up now and then.
[[nodiscard]] bool dropUnderWay(const Signals& signals);
/// A signal was dropped and nothing else is still to be given: no patience will bring it, and to give the last one
/// promised puts nothing ahead of OpenGL.
[[nodiscard]] bool signalLost(const Signals& signals);

}  // namespace sluice::stress
