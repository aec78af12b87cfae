// SPDX-License-Identifier: MIT
// Latitude-longitude environment maps from image files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "sluice/result.hpp"

namespace sluice::cli {

/// Linear RGB, rows from the zenith down, as SluiceEnvironment wants it.
struct Environment {
    std::uint32_t width = 0, height = 0;
    std::vector<float> pixels;
};

/// Any file that OpenImageIO reads (EXR, HDR, PNG, JPEG, ...). Integer files are taken as sRGB and decoded; float files
/// as linear. One channel becomes grey. Values that are negative or not finite are an error that names the pixel.
[[nodiscard]] Result<Environment> loadEnvironment(const std::filesystem::path& path);

}  // namespace sluice::cli
