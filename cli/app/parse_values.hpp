// SPDX-License-Identifier: MIT
// The small languages of command-line values.
#pragma once

#include <cstdint>
#include <string_view>

#include "sluice/host_gl/fault_plan.hpp"
#include "sluice/host_gl/host_fault.hpp"
#include "sluice/result.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// "A..B" with 0 <= A <= B, or "A" for one frame.
[[nodiscard]] Result<scene::FrameRange> parseFrameRange(std::string_view text);
/// "WxH", each 1 to 16384.
[[nodiscard]] Result<scene::Size> parseSize(std::string_view text);
/// 1 to SLUICE_MAX_IMAGE_SETS.
[[nodiscard]] Result<std::uint32_t> parseImageSets(std::string_view text);
/// 1 to SLUICE_MAX_FRAMES_IN_FLIGHT.
[[nodiscard]] Result<std::uint32_t> parseFramesInFlight(std::string_view text);
/// Digits alone, up to 2^64-1; `what` names the option.
[[nodiscard]] Result<std::uint64_t> parseWhole(std::string_view what, std::string_view text);
/// Metres, above 0.
[[nodiscard]] Result<float> parseRadius(std::string_view text);

/// Whether `text` begins with the name of a host fault; all else is parseFault's.
[[nodiscard]] bool namesHostFault(std::string_view text);
/// KIND@FRAME, with =VALUE behind it where the kind has one.
[[nodiscard]] Result<host::HostFault> parseHostFault(std::string_view text);
/// KIND@FRAME, KIND/to-renderer@FRAME, KIND/to-host@FRAME or KIND/simulation@FRAME, with =VALUE behind it where the
/// kind has one.
[[nodiscard]] Result<host::FaultPlan> parseFault(std::string_view text);
/// Seconds, above 0 and at most 3600.
[[nodiscard]] Result<double> parseDeadline(std::string_view text);

/// What all of them answer to a wrong text.
[[nodiscard]] Error badValue(std::string_view what, std::string_view expected, std::string_view found);

}  // namespace sluice::cli
