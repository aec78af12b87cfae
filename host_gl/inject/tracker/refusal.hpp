// SPDX-License-Identifier: MIT
// Frames that can have no fluid, and why. Pure.
#pragma once

#include <cstdint>
#include <string>

#include "tracker/frame_tracker.hpp"

namespace sluice::inject {

/// What a frame of the program is drawn with.
struct FrameFacts {
    bool stereo = false;            ///< the window has a picture for each eye
    std::uint32_t draw_buffer = 0;  ///< GL_DRAW_BUFFER
};

/// Empty: there can be fluid.
[[nodiscard]] std::string refusal(const FoundCamera& camera, const FrameFacts& facts);
/// What is said once of a program in which no camera has been found for so many frames; empty: not yet.
[[nodiscard]] std::string noCamera(std::uint64_t frames, const FrameSummary& last);

}  // namespace sluice::inject
