// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "app/body_files.hpp"
#include "app/checked_setup.hpp"
#include "app/commands.hpp"
#include "app/depth_files.hpp"
#include "app/file_roles.hpp"
#include "app/interrupt.hpp"
#include "app/log.hpp"
#include "app/mesh_files.hpp"
#include "app/output_folders.hpp"
#include "app/outputs.hpp"
#include "app/simulate_setup.hpp"
#include "app/start_file.hpp"
#include "report/progress.hpp"
#include "report/simulation_report.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::cli {
namespace {

/// A run in progress.
struct Run {
    const SimulateOptions& options;
    const scene::Scene& scene;
    const scene::Simulation& settings;
    const simulator::Setup& setup;
    scene::FrameRange frames;
    simulator::Simulator simulator;
    OutputFolders& folders;
    SimulationSummary summary;
    double compressions = 0.0;  ///< sum of the frames'
};

/// No output may be one of the inputs, whichever frame's it is.
Status checkRoles(const SimulateOptions& options, const scene::Simulation& settings, scene::FrameRange frames) {
    FileRoles roles;
    roles.add("the scene file", options.scene);
    for (const scene::SolidMesh& mesh : settings.meshes) {
        roles.add("the mesh file", mesh.path);
    }
    if (!settings.start.empty()) {
        roles.add("the file of the start", settings.start);
    }
    const auto depths = depthFiles(settings, frames.last);
    for (const std::filesystem::path& path : depths ? depths.value() : std::vector<std::filesystem::path>{}) {
        roles.add("the depth's file", path);
    }
    for (std::int64_t frame = frames.first; frame <= frames.last; ++frame) {
        const Result<std::filesystem::path> path = outputPath(options.output, frame);
        if (!path) {
            return path.error();
        }
        if (Status status = roles.check("the output file (-o)", path.value()); !status) {
            return status;
        }
        if (Status status = settings.bodies.empty()
                                ? Status{}
                                : roles.check("the bodies' file beside the output (-o)", bodiesPath(path.value()));
            !status) {
            return status;
        }
    }
    return {};
}

Status checkRequest(const SimulateOptions& options, const scene::Simulation& settings, scene::FrameRange frames) {
    if (frames.first < 1) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "--frames", "expected frames from 1, found 0",
                     "frame 1 is the start"};
    }
    if (frames.count() > 1 && !particles::Sequence{options.output}.numbered()) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "-o",
                     fmt::format("\"{}\" has no place for the number of {} frames", options.output, frames.count()),
                     "put #### or %04d into the name"};
    }
    const Result<std::filesystem::path> first = outputPath(options.output, frames.first);
    if (!first) {
        return first.error();
    }
    if (Status status = particles::checkEnding(first.value()); !status) {
        return status;
    }
    return checkRoles(options, settings, frames);
}

/// What the fluid meets on its way to `number`: what the picture before shows.
Status look(Run& run, std::int64_t number) {
    if (run.setup.seen == nullptr || !depthMoves(run.settings) || number == 2) {
        return {};
    }
    const auto seen = loadDepth(run.scene, number - 1);
    return seen ? run.simulator.setDepth(*seen.value()) : Status{seen.error()};
}

/// The fluid one frame further, to that number.
Status goOn(Run& run, std::int64_t number) {
    if (Status status = look(run, number); !status) {
        return status;
    }
    const auto begin = std::chrono::steady_clock::now();
    const double frame = 1.0 / double{run.settings.frames_per_second};
    const Result<simulator::Advance> done =
        run.simulator.advance(frame, std::min(1.0, frame / run.settings.steps_per_frame), interrupted);
    run.summary.solver_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!done) {
        return done.error();
    }
    SimulationSummary& s = run.summary;
    const simulator::Advance& a = done.value();
    if (a.stopped) {
        return {};  // who asked for it finds out by itself
    }
    s.simulated_s += frame;
    s.shortest_step = s.steps == 0 ? a.shortest : std::min(s.shortest_step, a.shortest);
    s.steps += a.steps;
    s.split += a.split;
    s.speed = std::max(s.speed, a.speed);
    s.most_neighbours = std::max(s.most_neighbours, a.most_neighbours);
    s.greatest_density = std::max(s.greatest_density, a.greatest_density);
    s.born += a.born;
    s.blocked += a.blocked;
    s.drained += a.drained;
    run.compressions += a.mean_compression;
    return {};
}

Status write(Run& run, std::int64_t frame, simulator::Particles&& particles) {
    const Result<std::filesystem::path> path = outputPath(run.options.output, frame);
    if (!path) {
        return path.error();
    }
    if (Status status = run.folders.prepare(path.value()); !status) {
        return status;
    }
    particles::ParticleSet set;
    set.radius = run.settings.radius;
    for (const std::uint32_t fluid : particles.fluid) {
        const scene::Vec3& colour = run.settings.fluids[fluid].colour;
        set.colour.insert(set.colour.end(), colour.begin(), colour.end());
    }
    set.position = std::move(particles.position);
    set.velocity = std::move(particles.velocity);
    Status status = particles::save(path.value(), set);
    if (status) {
        run.summary.files.push_back(path.value().string());
        if (!run.setup.bodies.empty()) {
            status = writeBodies(path.value(), run.setup, run.simulator.bodies());
        }
    }
    return status;
}

/// Says it as an error, and remembers it for the summary.
int stopped(Run& run, const Error& error, int code) {
    logError(error);
    run.summary.problems.push_back(error.message());
    return code;
}

/// What a signal has ended; the files are those of the frames before.
int interruptedIn(const Run& run, std::int64_t frame) {
    log(SLUICE_LOG_WARNING, fmt::format("interrupted in frame {} of {} to {}, which is not written; files written: {}",
                                        frame, run.frames.first, run.frames.last, run.summary.files.size()));
    return kExitInterrupted;
}

int runFrames(Run& run) {
    Progress progress(static_cast<std::uint64_t>(run.frames.last), !run.options.quiet);
    for (std::int64_t frame = 1; frame <= run.frames.last; ++frame) {
        progress.update(static_cast<std::uint64_t>(frame - 1), fmt::format("frame {}", frame));
        if (const Status status = frame > 1 ? goOn(run, frame) : Status{}; !status) {
            return stopped(run, status.error(), kExitNoFluid);
        }
        if (interrupted()) {
            return interruptedIn(run, frame);
        }
        Result<simulator::Particles> particles = run.simulator.read();
        if (!particles) {
            return stopped(run, particles.error(), kExitNoFluid);
        }
        run.summary.particles_at_end = particles.value().position.size() / 3;
        run.summary.replay_hash = replayHash(particles.value(), run.summary.replay_hash);
        if (frame >= run.frames.first) {
            if (const Status status = write(run, frame, std::move(particles).value()); !status) {
                return stopped(run, status.error(), kExitInternal);
            }
        }
    }
    run.summary.validation_messages = run.simulator.validationMessages();
    return run.summary.validation_messages > 0 ? kExitNoFluid : kExitOk;
}

/// With what files hold: meshes, or what is seen of them.
Result<simulator::Setup> wholeSetup(const scene::Scene& scene, std::int64_t last, const std::string& name) {
    const scene::Simulation& settings = scene.simulation;
    const bool by_depth = settings.collide == scene::kCollideDepth;
    const Result<std::vector<simulator::Mesh>> meshes =
        by_depth ? std::vector<simulator::Mesh>{} : readMeshes(settings);
    if (!meshes) {
        return meshes.error();
    }
    Result<simulator::Setup> setup = checkedSetup(scene, meshes.value());
    if (!setup) {
        Error error = setup.error();
        error.thing = name + ": " + error.thing;
        return error;
    }
    if (by_depth) {
        auto seen = firstDepth(scene, last);
        if (!seen) {
            Error error = seen.error();
            error.thing = settings.depth.path.empty() ? name + ": " + error.thing : error.thing;
            return error;
        }
        setup.value().seen = std::move(seen).value();
    }
    return setup;
}

int finish(Run& run, int code) {
    SimulationSummary& s = run.summary;
    s.exit_code = code;
    s.passes = run.simulator.times();
    s.mean_compression = run.compressions / static_cast<double>(std::max<std::int64_t>(run.frames.last - 1, 1));
    if (run.options.json) {
        fmt::print("{}\n", simulationJson(s).dump(2));
    } else if (!run.options.quiet) {
        fmt::print("{}", simulationText(s));
    }
    return code;
}

}  // namespace

int simulate(const SimulateOptions& options) {
    const Result<scene::Scene> scene = scene::loadScene(options.scene);
    if (!scene) {
        logError(scene.error());
        return kExitBadInput;
    }
    const scene::FrameRange frames = options.frames.value_or(scene.value().frames);
    const scene::Simulation& settings = scene.value().simulation;
    if (const Status status = checkRequest(options, settings, frames); !status) {
        logError(status.error());
        return kExitUsage;
    }
    Result<simulator::Setup> whole = wholeSetup(scene.value(), frames.last, options.scene);
    if (!whole) {
        logError(whole.error());
        return whole.error().code == SLUICE_ERROR_INVALID_ARGUMENT ? kExitBadInput : kExitInternal;
    }
    simulator::Setup& setup = whole.value();
    Result<simulator::Particles> start = wholeStart(settings, setup, options.seed);
    if (!start) {
        Error error = start.error();
        error.thing = options.scene + ": " + error.thing;
        logError(error);
        return kExitBadInput;
    }
    watchForInterrupt();
    OutputFolders folders;
    if (const Status status = folders.prepare(outputPath(options.output, frames.first).value()); !status) {
        logError(status.error());
        return kExitInternal;
    }
    Result<simulator::Simulator> made = simulator::Simulator::create(setup, options.validation);
    if (!made) {
        logError(made.error());
        return made.error().code == SLUICE_ERROR_INVALID_ARGUMENT ? kExitBadInput : kExitNoFluid;
    }
    Run run{options, scene.value(), settings, setup, frames, std::move(made).value(), folders, {}};
    run.summary.scene = options.scene;
    run.summary.device = run.simulator.device();
    run.summary.first = frames.first;
    run.summary.last = frames.last;
    run.summary.radius = settings.radius;
    run.summary.particles = start.value().position.size() / 3;
    run.summary.replay_hash = kReplayHashStart;
    if (const Status status = run.simulator.setParticles(start.value()); !status) {
        logError(status.error());
        return status.error().code == SLUICE_ERROR_INVALID_ARGUMENT ? kExitBadInput : kExitNoFluid;
    }
    return finish(run, runFrames(run));
}

}  // namespace sluice::cli
