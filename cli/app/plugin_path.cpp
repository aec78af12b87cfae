// SPDX-License-Identifier: MIT
#include "app/plugin_path.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <system_error>

namespace sluice::cli {

std::vector<std::filesystem::path> pluginCandidates(const std::string& option, const std::string& variable,
                                                    const std::filesystem::path& program) {
    if (!option.empty()) {
        return {option};
    }
    if (!variable.empty()) {
        return {variable};
    }
    const std::filesystem::path folder = program.parent_path();
    return {folder / kPluginFile, (folder / "../lib/sluice" / kPluginFile).lexically_normal()};
}

std::vector<std::filesystem::path> pluginPlaces(const std::string& option) {
    std::error_code ignored;
    const char* variable = std::getenv(kPluginVariable);
    return pluginCandidates(option, variable == nullptr ? "" : variable,
                            std::filesystem::read_symlink("/proc/self/exe", ignored));
}

std::filesystem::path rendererProgram() {
    std::error_code ignored;
    return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / kRendererProgram;
}

Result<std::filesystem::path> findPlugin(const std::string& option) {
    std::error_code ignored;
    std::string looked;
    for (const std::filesystem::path& candidate : pluginPlaces(option)) {
        if (std::filesystem::exists(candidate, ignored)) {
            return candidate;
        }
        looked += (looked.empty() ? "" : " and ") + candidate.string();
    }
    return Error{SLUICE_ERROR_UNSUPPORTED, "renderer plugin", fmt::format("not found at {}", looked),
                 fmt::format("give its path with --plugin or {}", kPluginVariable)};
}

Result<host::PluginLibrary> loadPlugin(const std::string& option) {
    const Result<std::filesystem::path> path = findPlugin(option);
    return path ? host::PluginLibrary::load(path.value()) : Result<host::PluginLibrary>{path.error()};
}

}  // namespace sluice::cli
