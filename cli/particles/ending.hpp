// SPDX-License-Identifier: MIT
// Which format a file name's ending stands for.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace sluice::particles {

enum class Format : std::uint8_t { pos, ply, bgeo, bgeo_gzip };

inline constexpr const char* kEndings = "the ending .pos, .ply, .bgeo, .bgeo.gz, .bhclassic or .bhclassic.gz";

[[nodiscard]] inline std::optional<Format> formatOf(const std::filesystem::path& path) {
    std::string name = path.filename().string();
    std::ranges::transform(name, name.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    if (name.ends_with(".pos")) {
        return Format::pos;
    }
    if (name.ends_with(".ply")) {
        return Format::ply;
    }
    if (name.ends_with(".bgeo") || name.ends_with(".bhclassic")) {
        return Format::bgeo;
    }
    if (name.ends_with(".bgeo.gz") || name.ends_with(".bhclassic.gz")) {
        return Format::bgeo_gzip;
    }
    return std::nullopt;
}

}  // namespace sluice::particles
