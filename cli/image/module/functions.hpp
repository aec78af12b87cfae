// SPDX-License-Identifier: MIT
// What libsluice_images.so does for the program. Debian's OpenImageIO brings 250 libraries with it, a fifth of a second
// of every start; so the program loads this module when it first has a picture to write, or a map or depths to read.
#pragma once

#include "image/depth_layer.hpp"
#include "image/environment.hpp"
#include "image/exr.hpp"
#include "image/png.hpp"

namespace sluice::cli::images {

/// C++ goes through this door: program and module are of one build, which `build` proves.
struct Functions {
    const char* build;
    Status (*write_png)(const std::filesystem::path& path, const host::Pixels& pixels);
    Status (*write_exr)(const std::filesystem::path& path, const LayeredImage& image);
    Result<Environment> (*load_environment)(const std::filesystem::path& path);
    Result<DepthLayer> (*read_depth_layer)(const std::filesystem::path& path, bool contents);
};

inline constexpr const char* kBuild = "sluice " SLUICE_VERSION ", " __VERSION__;
inline constexpr const char* kEntry = "sluice_images_entry";
using Entry = const Functions* (*)();

[[nodiscard]] Status writePng(const std::filesystem::path& path, const host::Pixels& pixels);
[[nodiscard]] Status writeExr(const std::filesystem::path& path, const LayeredImage& image);
[[nodiscard]] Result<Environment> loadEnvironment(const std::filesystem::path& path);
[[nodiscard]] Result<DepthLayer> readDepthLayer(const std::filesystem::path& path, bool contents);

}  // namespace sluice::cli::images
