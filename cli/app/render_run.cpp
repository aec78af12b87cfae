// SPDX-License-Identifier: MIT
#include "app/render_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/body_files.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/log.hpp"
#include "app/looks.hpp"
#include "app/outputs.hpp"
#include "app/user_words.hpp"
#include "image/exr.hpp"
#include "image/png.hpp"
#include "report/progress.hpp"

namespace sluice::cli {
namespace {

/// Says it once, as an error, unless FluidHost has, and remembers it for the summary.
void noteProblem(Run& run, const Error& error, std::optional<std::int64_t> frame = {}) {
    const std::string message = inUserWords(error.message());
    const bool refused = error.code == SLUICE_ERROR_INVALID_ARGUMENT || error.code == SLUICE_ERROR_UNSUPPORTED;
    const bool told = run.session.fluid && run.session.fluid->recovering() && !refused;
    if (run.last_problem != message) {
        if (!told) {
            log(SLUICE_LOG_ERROR, message + "; the host's frame goes on without fluid");
        }
        run.summary.problems.push_back(frame ? fmt::format("frame {}: {}", *frame, message) : message);
        run.last_problem = message;
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
    Result<std::vector<host::MovingBody>> bodies = readBodies(run.inputs.scene, path.value());
    if (!bodies) {
        return bodies.error();
    }
    run.inputs.bodies = std::move(bodies).value();
    std::optional<LoadedParticles> first = std::exchange(run.inputs.first, std::nullopt);
    const Result<particles::ParticleSet> set = first && first->path == path.value()
                                                   ? Result<particles::ParticleSet>{std::move(first->set)}
                                                   : loadParticles(run.inputs.scene.particles, path.value());
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
        const std::vector<std::uint32_t> fluids = fluidsOf(set.value(), run.inputs.scene);
        SluiceParticles view = particleView(set.value());
        view.fluid = fluids.empty() ? nullptr : fluids.data();
        if (const Status status = run.session.fluid->setParticles(view); !status) {
            noteProblem(run, status.error(), frame);
            // Particles that were refused would leave the last ones in the picture; all else is FluidHost's to mend.
            if (status.error().code == SLUICE_ERROR_INVALID_ARGUMENT) {
                run.session.fluid.reset();
            }
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
        const SluiceCamera camera = scene::cameraAt(run.inputs.scene, frame, run.inputs.size);
        LayeredImage image = layeredImage(result.layers, camera.near_plane, camera.far_plane);
        ImageCamera& lens = image.camera.emplace();
        std::copy_n(&camera.view[0], 16, lens.view.begin());
        std::copy_n(&camera.projection[0], 16, lens.projection.begin());
        lens.near_plane = camera.near_plane;
        if (Status status = writeExr(layers.value(), image); !status) {
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
    s.logic.ms.push_back(result.logic_ms);
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

/// A fluid that could not flow on stands still in the pictures from there on, and the run says so once.
void noteSimulation(Run& run) {
    if (!run.live || !run.session.fluid) {
        return;
    }
    if (const std::optional<std::string> why = run.live->end(*run.session.fluid)) {
        run.summary.problems.push_back(*why);  // the plugin has logged it
        run.summary.exit_code = kExitNoFluid;
    }
    run.summary.live = run.live->summary();
    if (run.summary.live) {
        run.summary.particles = run.summary.live->stats.particle_count;  // emitters and drains change it
    }
}

/// An order that is wrong may leave no other trace.
void noteFault(Run& run, std::int64_t frame) {
    const std::optional<host::FaultPlan>& fault = run.options.fault;
    if (fault && !host::ofProcess(fault->kind) && run.session.fluid && run.submitted < fault->frame &&
        run.session.fluid->frame() >= fault->frame) {
        log(SLUICE_LOG_WARNING, fmt::format("--fault: injected in frame {}", frame));
    }
    const std::optional<host::HostFault>& other = run.options.host_fault;
    if (other && run.session.fluid && static_cast<std::uint64_t>(frame - run.inputs.frames.first) + 1 == other->frame) {
        log(SLUICE_LOG_WARNING, fmt::format("--fault: injected in frame {}", frame));
    }
    run.submitted = run.session.fluid ? run.session.fluid->frame() : run.submitted;
}

/// Draws and writes every frame. The returned code is that of the first thing that ended the run, or 0.
int renderFrames(Run& run) {
    Progress progress(static_cast<std::uint64_t>(run.inputs.frames.count()), !run.options.quiet);
    for (std::int64_t frame = run.inputs.frames.first; frame <= run.inputs.frames.last; ++frame) {
        if (interrupted()) {
            return kExitInterrupted;
        }
        progress.update(run.summary.frames_written, fmt::format("frame {}", frame));
        if (run.live) {
            if (const Status status = run.live->begin(run.session.fluid.get(), frame); !status) {
                noteProblem(run, status.error(), frame);
            }
        } else if (const Status status = updateParticles(run, frame); !status) {
            logError(status.error());
            return kExitBadInput;
        }
        const FrameResult result = renderFrame(run.session, run.inputs, run.options, frame);
        if (result.failure && interrupted()) {
            return kExitInterrupted;  // the wait was cut short, and the same frame may well have fluid next time
        }
        if (result.failure) {
            noteProblem(run, *result.failure, frame);
        }
        noteFault(run, frame);
        account(run, result);
        noteSimulation(run);
        if (const Status status = writeFiles(run, result, frame); !status) {
            logError(status.error());
            return kExitInternal;
        }
        run.summary.frames_written += 1;
    }
    return interrupted() ? kExitInterrupted : kExitOk;
}

void describeRenderer(Run& run) {
    run.summary.has_renderer = true;
    run.summary.plugin = run.session.library->path().string();
    run.summary.renderer = fmt::format("{} {}", run.session.library->api().name, run.session.library->api().version);
    run.summary.info = run.session.fluid->info();
    run.summary.timeline_reason = run.session.timeline_reason;
}

}  // namespace

/// What a frame takes on the CPU, at least: four floats a pixel read back, the PNG's bytes, and with layers ten images
/// of up to four floats and the seventeen channels made of them.
Error noMemory(scene::Size size, bool layers) {
    const std::uint64_t pixel = layers ? 20 + 10 * 8 + 17 * 4 : 20;
    const std::uint64_t bytes = std::uint64_t{size.width} * size.height * pixel;
    return Error{SLUICE_ERROR_OUT_OF_MEMORY, fmt::format("a frame of {}x{}", size.width, size.height),
                 fmt::format("there is not enough memory; its pixels alone take about {} bytes", bytes),
                 layers ? "give a smaller --size, or leave out --layers" : "give a smaller --size"};
}

int renderAll(Run& run) {
    try {
        if (!run.options.no_fluid) {
            if (const Status status = startFluid(run.session, run.inputs, run.options); !status) {
                if (run.options.fault || run.options.host_fault) {
                    log(SLUICE_LOG_WARNING, "--fault: there is no renderer, so nothing was injected");
                }
                if (!interrupted()) {
                    noteProblem(run, status.error());
                }
            } else {
                describeRenderer(run);
            }
        }
        return renderFrames(run);
    } catch (const std::bad_alloc&) {
        const Error error = noMemory(run.inputs.size, !run.options.layers.empty());
        logError(error);
        run.summary.problems.push_back(error.message());
        return kExitInternal;
    }
}

}  // namespace sluice::cli
