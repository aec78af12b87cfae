// SPDX-License-Identifier: MIT
// PNG files.
#pragma once

#include <filesystem>

#include "sluice/host_gl/screen.hpp"
#include "sluice/result.hpp"

namespace sluice::cli {

/// 8-bit sRGB from the first three channels, which are sRGB-encoded in [0,1]. Whole or not at all.
[[nodiscard]] Status writePng(const std::filesystem::path& path, const host::Pixels& pixels);

}  // namespace sluice::cli
