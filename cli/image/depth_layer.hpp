// SPDX-License-Identifier: MIT
// A picture's depths from an EXR, and the camera that it says it is of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "image/exr.hpp"
#include "sluice/result.hpp"

namespace sluice::cli {

struct DepthLayer {
    std::uint32_t width = 0, height = 0;
    std::optional<ImageCamera> camera;  ///< none: the file says nothing of it
    std::vector<float> depth;           ///< metres along -z, bottom row first
};

/// The channel "host.Z", as `sluice render --layers` writes it, or else "Z". Errors name what the file lacks.
/// `contents`: else only what is in its header.
[[nodiscard]] Result<DepthLayer> readDepthLayer(const std::filesystem::path& path, bool contents = true);

}  // namespace sluice::cli
