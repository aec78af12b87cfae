// SPDX-License-Identifier: MIT
// The small languages of command-line values.
#pragma once

#include <string_view>

#include "sluice/result.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// "A..B" with 0 <= A <= B, or "A" for one frame.
[[nodiscard]] Result<scene::FrameRange> parseFrameRange(std::string_view text);
/// "WxH", each 1 to 16384.
[[nodiscard]] Result<scene::Size> parseSize(std::string_view text);

}  // namespace sluice::cli
