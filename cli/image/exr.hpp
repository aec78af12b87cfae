// SPDX-License-Identifier: MIT
// OpenEXR files of many named channels.
#pragma once

#include <cstdint>
#include <filesystem>
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

struct LayeredImage {
    std::uint32_t width = 0, height = 0;
    std::vector<Channel> channels;
};

/// One part, ZIP-compressed scan lines. Whole or not at all.
[[nodiscard]] Status writeExr(const std::filesystem::path& path, const LayeredImage& image);

}  // namespace sluice::cli
