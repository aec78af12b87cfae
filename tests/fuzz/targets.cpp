// SPDX-License-Identifier: MIT
#include "targets.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "builder.hpp"
#include "encode.hpp"
#include "gzip.hpp"
#include "sluice/particles/particles.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::fuzz {

namespace {

using particles::Format;
using particles::ParticleSet;
using Parser = Result<ParticleSet> (*)(std::span<const std::byte>, const std::string&);

[[noreturn]] void broken(const char* promise) {
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

void require(bool condition, const char* promise) {
    if (!condition) {
        broken(promise);
    }
}

bool allFinite(const std::vector<float>& values) {
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
}

bool sameBits(const std::vector<float>& a, const std::vector<float>& b) {
    const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
    return std::ranges::equal(a, b, {}, bits, bits);
}

/// `bytes` is the size of what was parsed, after inflation: no particle takes less than three bytes of it.
void checkSet(const ParticleSet& set, std::uint64_t bytes) {
    require(set.position.size() % 3 == 0, "positions come in triples");
    require(set.velocity.empty() || set.velocity.size() == set.position.size(), "a velocity for each particle or none");
    require(set.colour.empty() || set.colour.size() == set.position.size(), "a colour for each particle or none");
    require(allFinite(set.position) && allFinite(set.velocity) && allFinite(set.colour), "values are finite");
    require(std::ranges::all_of(set.colour, [](float c) { return c >= 0.0F && c <= 1.0F; }), "colours are in [0,1]");
    require(set.radius == 0.0F || particles::usableRadius(set.radius), "the radius is none or usable");
    require(set.count() <= bytes / 3, "no particle comes from nowhere");
}

void checkAgain(const ParticleSet& set, Format format, Parser parse) {
    const Result<std::vector<std::byte>> bytes = particles::encode(set, format, "again");
    require(bytes.ok(), "a set that was read can be written");
    const Result<ParticleSet> back = parse(bytes.value(), "again");
    require(back.ok(), "a set that was written can be read");
    require(back.value().radius == set.radius, "the radius survives");
    require(sameBits(back.value().position, set.position), "the positions survive");
    require(sameBits(back.value().velocity, set.velocity), "the velocities survive");
    require(sameBits(back.value().colour, set.colour), "the colours survive");
}

void run(std::span<const std::byte> bytes, Format format, Parser parse) {
    const Result<ParticleSet> set = parse(bytes, "fuzz");
    if (!set) {
        require(set.error().code == SLUICE_ERROR_INVALID_ARGUMENT, "a bad file is an invalid argument");
        require(set.error().thing == "fuzz" && set.error().detail.starts_with("at "), "an error names file and place");
        require(set.error().message().size() < 1000, "a message is short, whatever the file holds");
        return;
    }
    checkSet(set.value(), particles::looksLikeGzip(bytes) ? particles::inflateLimit(bytes.size()) : bytes.size());
    checkAgain(set.value(), format, parse);
}

}  // namespace

void breakPromise() {
    broken("none was kept");
}

void pos(std::span<const std::byte> bytes) {
    run(bytes, Format::pos, particles::parsePos);
}
void ply(std::span<const std::byte> bytes) {
    run(bytes, Format::ply, particles::parsePly);
}
void bgeo(std::span<const std::byte> bytes) {
    run(bytes, Format::bgeo, particles::parseBgeo);
}

void scene(std::span<const std::byte> bytes) {
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const Result<scene::Scene> read = scene::parseScene(text, "fuzz");
    if (!read) {
        require(read.error().code == SLUICE_ERROR_INVALID_ARGUMENT, "a bad scene is an invalid argument");
        require(read.error().message().starts_with("fuzz"), "an error names the file");
        require(read.error().message().size() < 1000, "a message is short, whatever the scene holds");
        return;
    }
    const std::string written = scene::writeScene(read.value());
    const Result<scene::Scene> back = scene::parseScene(written, "again");
    require(back.ok(), "a scene that was written can be read");
    require(scene::writeScene(back.value()) == written, "a scene survives writing and reading");
    const SluiceCamera camera = scene::cameraAt(read.value(), read.value().frames.last, read.value().size);
    require(std::ranges::all_of(camera.view, [](float value) { return std::isfinite(value); }),
            "every accepted scene has a camera");
}

Target targetNamed(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, Target>, 6> kTargets{{{"pos", pos},
                                                                           {"ply", ply},
                                                                           {"bgeo", bgeo},
                                                                           {"scene", scene},
                                                                           {"ledger_log", ledger_log},
                                                                           {"isolate", isolate}}};
    const auto* found = std::ranges::find(kTargets, name, &std::pair<std::string_view, Target>::first);
    return found == kTargets.end() ? nullptr : found->second;
}

}  // namespace sluice::fuzz
