// SPDX-License-Identifier: MIT
// Where the renderer plugin is looked for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sluice/host_gl/plugin_library.hpp"
#include "sluice/result.hpp"

namespace sluice::cli {

inline constexpr const char* kPluginFile = "libsluice_renderer_vk.so";
inline constexpr const char* kRendererProgram = "sluice-renderer";
inline constexpr const char* kPluginVariable = "SLUICE_PLUGIN";

/// Pure. Places in order: what was asked for on the command line, alone; else the environment variable's value, alone;
/// else next to the program, then ../lib/sluice. Empty strings count as not given.
[[nodiscard]] std::vector<std::filesystem::path> pluginCandidates(const std::string& option,
                                                                  const std::string& variable,
                                                                  const std::filesystem::path& program);

/// pluginCandidates of this process.
[[nodiscard]] std::vector<std::filesystem::path> pluginPlaces(const std::string& option);

/// The process of an isolated renderer stands beside this program.
[[nodiscard]] std::filesystem::path rendererProgram();

/// The first candidate that exists. The error names every place that was looked at.
[[nodiscard]] Result<std::filesystem::path> findPlugin(const std::string& option);

/// Loads the first candidate that exists. The error names every place that was looked at.
[[nodiscard]] Result<host::PluginLibrary> loadPlugin(const std::string& option);

}  // namespace sluice::cli
