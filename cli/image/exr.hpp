// SPDX-License-Identifier: MIT
// OpenEXR files of many named channels.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sluice/result.hpp"

namespace sluice::cli {

/// One channel, rows from the top down. "R" belongs to the unnamed (beauty) layer, "host.R" to the layer "host".
struct Channel {
    std::string name;
    bool half = true;  ///< stored as 16-bit float; depth and lengths keep 32
    std::vector<float> values;
};

/// Whose picture it is: column-major, as SluiceCamera has it.
struct ImageCamera {
    std::array<float, 16> view{}, projection{};
    float near_plane = 0.0F;  ///< m
};

struct LayeredImage {
    std::uint32_t width = 0, height = 0;
    std::vector<Channel> channels;
    std::optional<ImageCamera> camera{};
};

/// One part, ZIP-compressed scan lines; the camera as attributes "worldToCamera", "sluice:projection" and
/// "sluice:near". Whole or not at all.
[[nodiscard]] Status writeExr(const std::filesystem::path& path, const LayeredImage& image);

}  // namespace sluice::cli
