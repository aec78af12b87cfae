// SPDX-License-Identifier: MIT
#include "app/outputs.hpp"

#include <fmt/format.h>

#include "sluice/particles/particles.hpp"

namespace sluice::cli {
namespace {

Status checkPattern(const char* option, const std::string& pattern, const char* ending, scene::FrameRange frames) {
    if (std::filesystem::path(pattern).extension() != ending) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, option,
                     fmt::format("expected a name that ends in {}, found \"{}\"", ending, pattern), ""};
    }
    if (frames.count() > 1 && !particles::Sequence{pattern}.numbered()) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, option,
                     fmt::format("\"{}\" has no place for the number of {} frames", pattern, frames.count()),
                     "put #### or %04d into the name"};
    }
    // Also finds a pattern with two places.
    const auto first = particles::Sequence{pattern}.path(frames.first);
    return first ? Status{} : Status{first.error()};
}

}  // namespace

Status checkOutputs(const RenderOptions& options, scene::FrameRange frames) {
    if (Status status = checkPattern("-o", options.output, ".png", frames); !status) {
        return status;
    }
    return options.layers.empty() ? Status{} : checkPattern("--layers", options.layers, ".exr", frames);
}

std::string numberedPattern(const std::string& pattern, scene::FrameRange frames) {
    if (frames.count() <= 1 || particles::Sequence{pattern}.numbered()) {
        return pattern;
    }
    const std::filesystem::path path(pattern);
    return (path.parent_path() / path.stem()).string() + "_%04d" + path.extension().string();
}

Result<std::filesystem::path> outputPath(const std::string& pattern, std::int64_t frame) {
    return particles::Sequence{pattern}.path(frame);
}

}  // namespace sluice::cli
