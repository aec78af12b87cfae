// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <chrono>
#include <cstdio>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/log.hpp"
#include "app/outputs.hpp"
#include "app/render_inputs.hpp"
#include "app/render_session.hpp"
#include "image/exr.hpp"
#include "image/png.hpp"
#include "report/progress.hpp"
#include "report/summary.hpp"

namespace sluice::cli {
namespace {

/// A run in progress.
struct Run {
    const RenderOptions& options;
    RenderInputs inputs;
    RenderSession session;
    RunSummary summary;
    PassStatistics passes;
    std::vector<TraceRecord> records;  ///< kept only when a trace file is wanted
    std::filesystem::path particle_file;
};

/// Says it once, as an error, and remembers it for the summary.
void noteProblem(Run& run, const Error& error) {
    const std::string message = error.message();
    if (run.summary.problems.empty() || run.summary.problems.back() != message) {
        log(SLUICE_LOG_ERROR, message + "; the host's frame goes on without fluid");
        run.summary.problems.push_back(message);
    }
    run.summary.exit_code = kExitNoFluid;
}

/// Brings the frame's particles to the renderer. Failure of the file is returned; failure of the renderer is a problem.
Status updateParticles(Run& run, std::int64_t frame) {
    const Result<std::filesystem::path> path = particlePath(run.inputs.scene.particles, frame);
    if (!path) {
        return path.error();
    }
    if (path.value() == run.particle_file) {
        return {};
    }
    const Result<particles::ParticleSet> set = loadParticles(run.inputs.scene.particles, path.value());
    if (!set) {
        return set.error();
    }
    if (set.value().count() == 0) {
        log(SLUICE_LOG_WARNING, path.value().string() + ": holds no particles");
    }
    run.summary.particles = set.value().count();
    run.summary.radius = set.value().radius;
    run.particle_file = path.value();
    if (run.session.fluid) {
        if (const Status status = run.session.fluid->setParticles(particleView(set.value())); !status) {
            noteProblem(run, status.error());
            run.session.fluid.reset();
        }
    }
    return {};
}

Status writeFiles(Run& run, const FrameResult& result, std::int64_t frame) {
    const auto start = std::chrono::steady_clock::now();
    const Result<std::filesystem::path> picture = outputPath(run.options.output, frame);
    if (!picture) {
        return picture.error();
    }
    if (Status status = writePng(picture.value(), result.layers.beauty); !status) {
        return status;
    }
    run.summary.files.push_back(picture.value().string());
    if (!run.options.layers.empty()) {
        const Result<std::filesystem::path> layers = outputPath(run.options.layers, frame);
        if (!layers) {
            return layers.error();
        }
        const scene::CameraPath& camera = run.inputs.scene.camera;
        if (Status status = writeExr(layers.value(), layeredImage(result.layers, camera.near_plane, camera.far_plane));
            !status) {
            return status;
        }
        run.summary.files.push_back(layers.value().string());
    }
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    run.summary.write.ms.push_back(elapsed.count());
    return {};
}

void account(Run& run, const FrameResult& result) {
    RunSummary& s = run.summary;
    s.draw.ms.push_back(result.draw_ms);
    std::vector<TraceRecord> records = run.session.trace->drain();
    addCopies(s.copies, records);
    if (result.with_fluid) {
        s.frames_with_fluid += 1;
        s.submit.ms.push_back(result.submit_ms);
        s.composite.ms.push_back(result.composite_ms);
        s.wait.ms.push_back(waitMilliseconds(records));
    }
    if (result.stats) {
        run.passes.add(*result.stats);
        s.copies.shared_images += result.stats->cpu_copy_bytes;
        s.uploaded_bytes += result.stats->upload_bytes;
        s.validation_messages = result.stats->validation_messages;
    }
    if (!run.options.trace.empty()) {
        run.records.insert(run.records.end(), records.begin(), records.end());
    }
}

/// Draws and writes every frame. The returned code is that of the first thing that ended the run, or 0.
int renderFrames(Run& run) {
    Progress progress(static_cast<std::uint64_t>(run.inputs.frames.count()), !run.options.quiet);
    for (std::int64_t frame = run.inputs.frames.first; frame <= run.inputs.frames.last; ++frame) {
        if (interrupted()) {
            return kExitInterrupted;
        }
        progress.update(run.summary.frames_written, fmt::format("frame {}", frame));
        if (const Status status = updateParticles(run, frame); !status) {
            logError(status.error());
            return kExitBadInput;
        }
        const FrameResult result = renderFrame(run.session, run.inputs, run.options, frame);
        if (result.failure) {
            noteProblem(run, *result.failure);
        }
        account(run, result);
        if (const Status status = writeFiles(run, result, frame); !status) {
            logError(status.error());
            return kExitInternal;
        }
        run.summary.frames_written += 1;
    }
    return interrupted() ? kExitInterrupted : kExitOk;
}

/// The renderer's shut-down belongs to the trace too, so the trace is written after it.
int finish(Run& run, int code) {
    run.session.fluid.reset();
    std::vector<TraceRecord> last = run.session.trace->drain();
    run.summary.trace_dropped = run.session.trace->dropped();
    if (!run.options.trace.empty()) {
        run.records.insert(run.records.end(), last.begin(), last.end());
        if (const Status status = writeChromeTraceFile(run.options.trace, run.records, run.summary.trace_dropped);
            !status) {
            logError(status.error());
            code = kExitInternal;
        } else {
            run.summary.files.push_back(run.options.trace);
        }
    }
    run.summary.passes = run.passes.rows();
    if (code != kExitOk) {
        run.summary.exit_code = code;
    }
    if (run.options.json) {
        fmt::print("{}\n", summaryJson(run.summary).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    } else if (!run.options.quiet) {
        fmt::print("{}", summaryText(run.summary));
    }
    return run.summary.exit_code;
}

void describeRenderer(Run& run) {
    run.summary.has_renderer = true;
    run.summary.plugin = run.session.library->path().string();
    run.summary.renderer = fmt::format("{} {}", run.session.library->api().name, run.session.library->api().version);
    run.summary.info = run.session.fluid->info();
    run.summary.timeline_reason = run.session.timeline_reason;
}

}  // namespace

int render(const RenderOptions& options) {
    Result<RenderInputs> inputs = readScene(options);
    if (!inputs) {
        logError(inputs.error());
        return kExitBadInput;
    }
    if (const Status status = checkOutputs(options, inputs.value().frames); !status) {
        logError(status.error());
        return kExitUsage;
    }
    if (const Status status = checkInputs(inputs.value()); !status) {
        logError(status.error());
        return kExitBadInput;
    }
    Result<RenderSession> session = createSession(inputs.value());
    if (!session) {
        logError(session.error());
        return kExitInternal;
    }
    watchForInterrupt();
    Run run{options, std::move(inputs).value(), std::move(session).value(), {}, {}, {}, {}};
    run.summary.scene = options.scene;
    run.summary.frames = run.inputs.frames;
    run.summary.size = run.inputs.size;
    if (!options.no_fluid) {
        if (const Status status = startFluid(run.session, run.inputs, options); !status) {
            noteProblem(run, status.error());
        } else {
            describeRenderer(run);
        }
    }
    return finish(run, renderFrames(run));
}

}  // namespace sluice::cli
