// SPDX-License-Identifier: MIT
#include "tracker/refusal.hpp"

#include <fmt/format.h>

namespace sluice::inject {

namespace {

// GL_FRONT_LEFT to GL_BACK_RIGHT, and GL_LEFT and GL_RIGHT: buffers of one eye.
constexpr std::uint32_t kFirstEye = 0x0400, kLastEye = 0x0403, kLeft = 0x0406, kRight = 0x0407;
constexpr std::uint64_t kPatience = 300;  // frames

}  // namespace

std::string refusal(const FoundCamera& camera, const FrameFacts& facts) {
    const std::uint32_t buffer = facts.draw_buffer;
    if (facts.stereo && ((buffer >= kFirstEye && buffer <= kLastEye) || buffer == kLeft || buffer == kRight)) {
        return fmt::format("stereo: the program draws buffer 0x{:04x}, of one eye, and fluid for each is not to be had",
                           buffer);
    }
    if (camera.lens.reversed) {
        return fmt::format(
            "reversed depth: near {:.4g} lies at window depth 1 and far {:.4g} at 0, which the compositor does not "
            "know",
            camera.lens.near_plane, camera.lens.far_plane);
    }
    return {};
}

std::string noCamera(std::uint64_t frames, const FrameSummary& last) {
    if (frames != kPatience) {
        return {};
    }
    return fmt::format(
        "no camera in perspective in {} frames, {} orthographic or flat draws in the last: a program in "
        "two dimensions, or in parallel projection, gets no fluid (--report says what was seen)",
        frames, last.flat_draws);
}

}  // namespace sluice::inject
