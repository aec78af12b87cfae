// SPDX-License-Identifier: MIT
// Where this library finds the renderer that came with it.
#pragma once

#include <filesystem>

#include "sluice/result.hpp"

namespace sluice::host {

/// The folder that this very library was loaded from.
[[nodiscard]] std::filesystem::path libraryFolder();

/// What was asked for; else $SLUICE_PLUGIN; else libsluice_renderer_vk.so in `folder` or in sluice/ there. The error
/// names every place.
[[nodiscard]] Result<std::filesystem::path> pluginPlace(const char* asked, const std::filesystem::path& folder);
/// What was asked for; else sluice-renderer in `folder`, or in bin/ of a folder above it.
[[nodiscard]] Result<std::filesystem::path> rendererPlace(const char* asked, const std::filesystem::path& folder);

}  // namespace sluice::host
