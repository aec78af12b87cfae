// SPDX-License-Identifier: MIT
// PNG files, read by another library than the one that wrote them.
#pragma once

#include <filesystem>

#include "desktop.hpp"

namespace window::test {

/// Empty if it is no PNG.
[[nodiscard]] Rgb readPng(const std::filesystem::path& path);

}  // namespace window::test
