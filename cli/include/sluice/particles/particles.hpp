// SPDX-License-Identifier: MIT
// Particle sets from files: .pos, .ply (ascii, binary little-endian), classic Houdini .bgeo (plain or gzip).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sluice/result.hpp"

namespace sluice::particles {

/// A particle set in world metres, +y up. Triples are packed; velocity (m/s) and colour (linear RGB in [0,1]) are empty
/// or hold as many triples as position.
struct ParticleSet {
    float radius = 0.0F;  ///< 0 if the file has none
    std::vector<float> position;
    std::vector<float> velocity;
    std::vector<float> colour;
    bool radius_given = false;  ///< the radius is not the file's: load took its default
    [[nodiscard]] std::size_t count() const { return position.size() / 3; }
};

/// No format may claim more than this many particles: 256 Mi.
inline constexpr std::uint64_t kMaxParticles = 1ULL << 28;
/// No file may be larger: 16 GiB.
inline constexpr std::uint64_t kMaxFileBytes = 1ULL << 34;

/// Pure parsers. `name` is used in messages only. An Error names the file, the byte offset (or line), what was expected
/// and what was found; its code is SLUICE_ERROR_INVALID_ARGUMENT. Memory use is bounded by the size of `bytes` (for
/// gzip: by what kMaxParticles allows), never by a count that a header claims.
[[nodiscard]] Result<ParticleSet> parsePos(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] Result<ParticleSet> parsePly(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] Result<ParticleSet> parseBgeo(std::span<const std::byte> bytes, const std::string& name);

/// Reads a regular file and parses it by its ending (.pos, .ply, .bgeo, .bgeo.gz); anything else, such as a pipe, is
/// refused without waiting for it. A particle set without a radius gets
/// `default_radius`; if that is 0 too, it is an error whose remedy is `radius_remedy`: only the caller knows where its
/// user writes the radius.
[[nodiscard]] Result<ParticleSet> load(const std::filesystem::path& path, float default_radius = 0.0F,
                                       std::string_view radius_remedy = "give the radius in metres");

/// Whether save() knows what the file's ending stands for; an error that lists the endings if not.
[[nodiscard]] Status checkEnding(const std::filesystem::path& path);

/// Writes .pos, .ply (binary little-endian) or .bgeo by ending, whole or not at all.
[[nodiscard]] Status save(const std::filesystem::path& path, const ParticleSet& set);

/// A numbered sequence. `pattern` holds one printf integer conversion ("frame_%04d.pos") or one run of '#'
/// ("frame_####.pos"); without either it is a single file that serves for every frame.
struct Sequence {
    std::string pattern;
    [[nodiscard]] bool numbered() const;
    [[nodiscard]] Result<std::filesystem::path> path(std::int64_t frame) const;
};

}  // namespace sluice::particles
