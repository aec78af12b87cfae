// SPDX-License-Identifier: MIT
#include "sluice/particles/generate.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/log.hpp"
#include "app/output_folders.hpp"
#include "app/outputs.hpp"
#include "report/progress.hpp"
#include "report/table.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::cli {
namespace {

constexpr double kFramesPerSecond = 30.0;

/// Frame 1 is time 0.
double timeOf(std::int64_t frame) {
    return static_cast<double>(frame - 1) / kFramesPerSecond;
}

Status checkRequest(const GenerateOptions& options) {
    if (Status status = particles::checkEnding(options.output); !status) {
        return status;
    }
    if (options.frames.first < 1) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "--frames", "expected frames from 1, found 0", "frame 1 is time 0"};
    }
    if (options.frames.count() > 1 && !particles::Sequence{options.output}.numbered()) {
        return Error{
            SLUICE_ERROR_INVALID_ARGUMENT, "-o",
            fmt::format("\"{}\" has no place for the number of {} frames", options.output, options.frames.count()),
            "put #### or %04d into the name"};
    }
    return {};
}

}  // namespace

int generate(const GenerateOptions& options) {
    if (const Status status = checkRequest(options); !status) {
        logError(status.error());
        return kExitUsage;
    }
    watchForInterrupt();
    OutputFolders folders;
    const Result<std::filesystem::path> first = outputPath(options.output, options.frames.first);
    if (const Status status = first ? folders.prepare(first.value()) : Status{first.error()}; !status) {
        logError(status.error());
        return first ? kExitInternal : kExitUsage;
    }
    const auto total = static_cast<std::uint64_t>(options.frames.count());
    {
        Progress progress(total, !options.quiet);
        for (std::int64_t frame = options.frames.first; frame <= options.frames.last; ++frame) {
            if (interrupted()) {
                return kExitInterrupted;
            }
            progress.update(static_cast<std::uint64_t>(frame - options.frames.first), fmt::format("frame {}", frame));
            const Result<particles::ParticleSet> set =
                particles::generatePool(options.particles, options.seed, timeOf(frame));
            if (!set) {
                logError(set.error());
                return kExitUsage;
            }
            const Result<std::filesystem::path> path = outputPath(options.output, frame);
            Status saved = path ? folders.prepare(path.value()) : Status{path.error()};
            if (saved) {
                saved = particles::save(path.value(), set.value());
            }
            if (!saved) {
                logError(saved.error());
                return path ? kExitInternal : kExitUsage;
            }
            if (total == 1 && !options.quiet) {
                fmt::print("{}: {} particles of radius {:.5f} m\n", path.value().string(),
                           formatCount(set.value().count()), set.value().radius);
            }
        }
    }
    if (total > 1 && !options.quiet) {
        fmt::print("{}: {} files\n", options.output, total);
    }
    return kExitOk;
}

}  // namespace sluice::cli
