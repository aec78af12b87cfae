// SPDX-License-Identifier: MIT
#include "api/places.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <system_error>
#include <vector>

#include "sluice/sluice.h"

namespace sluice::host {

namespace {

constexpr const char* kPlugin = "libsluice_renderer_vk.so";
constexpr const char* kProgram = "sluice-renderer";
constexpr const char* kPluginVariable = "SLUICE_PLUGIN";

Result<std::filesystem::path> firstThere(const char* what, const std::vector<std::filesystem::path>& places,
                                         const char* remedy) {
    std::string looked;
    std::error_code ignored;
    for (const std::filesystem::path& place : places) {
        if (std::filesystem::exists(place, ignored)) {
            return place;
        }
        looked += (looked.empty() ? "" : " and ") + place.string();
    }
    return Error{SLUICE_ERROR_UNSUPPORTED, what, fmt::format("not found at {}", looked), remedy};
}

bool given(const char* text) {
    return text != nullptr && *text != '\0';
}

}  // namespace

std::filesystem::path libraryFolder() {
    Dl_info info{};
    // A function's address as dladdr takes it.
    if (::dladdr(reinterpret_cast<const void*>(&sluice_api_version), &info) == 0 || info.dli_fname == nullptr) {
        return {};
    }
    std::error_code failed;
    const std::filesystem::path real = std::filesystem::canonical(info.dli_fname, failed);
    return (failed ? std::filesystem::path(info.dli_fname) : real).parent_path();
}

Result<std::filesystem::path> pluginPlace(const char* asked, const std::filesystem::path& folder) {
    constexpr const char* kRemedy = "name it in SluiceOptions::plugin or SLUICE_PLUGIN";
    if (given(asked)) {
        return firstThere("renderer plugin", {asked}, kRemedy);
    }
    if (const char* variable = std::getenv(kPluginVariable); given(variable)) {
        return firstThere("renderer plugin", {variable}, kRemedy);
    }
    return firstThere("renderer plugin",
                      {folder / kPlugin, folder / "sluice" / kPlugin, folder / "../sluice" / kPlugin}, kRemedy);
}

Result<std::filesystem::path> rendererPlace(const char* asked, const std::filesystem::path& folder) {
    constexpr const char* kRemedy = "name it in SluiceOptions::renderer_program, or ask for SLUICE_PROCESS_SAME";
    if (given(asked)) {
        return firstThere("renderer program", {asked}, kRemedy);
    }
    return firstThere("renderer program",
                      {folder / kProgram, folder / "../bin" / kProgram, folder / "../../bin" / kProgram}, kRemedy);
}

}  // namespace sluice::host
