// SPDX-License-Identifier: MIT
// The names of output files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "app/options.hpp"
#include "sluice/result.hpp"

namespace sluice::cli {

/// Checks -o and --layers before any work: endings (.png, .exr) and, for more than one frame, a place for the number.
[[nodiscard]] Status checkOutputs(const RenderOptions& options, scene::FrameRange frames);

/// `pattern` itself, or, if `frames` are several and it has no place for their number, with _%04d before its ending.
[[nodiscard]] std::string numberedPattern(const std::string& pattern, scene::FrameRange frames);

/// `pattern` with the frame's number in place of its run of '#' or its "%04d".
[[nodiscard]] Result<std::filesystem::path> outputPath(const std::string& pattern, std::int64_t frame);

}  // namespace sluice::cli
