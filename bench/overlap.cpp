// SPDX-License-Identifier: MIT
// How much of a simulation hides behind the host's own work: the same frames one thing after the other, and with 1 to 3
// frames in flight, in turns, in one process. Prints a table in Markdown; scripts/overlap runs it and says where.
//   overlap [SCENE [FRAMES [ROUNDS [LOAD [RADIUS]]]]]   LOAD: the host's work as a multiple of the simulation's;
//   RADIUS: of the particles, metres; 0: the scene's
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "app/live_run.hpp"
#include "app/log.hpp"
#include "app/render_inputs.hpp"
#include "app/render_session.hpp"
#include "report/statistics.hpp"
#include "sluice/format.hpp"

namespace {

using namespace sluice;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kLong = 600'000'000'000;

double since(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

[[noreturn]] void stop(const Error& error) {
    (void)std::fprintf(stderr, "overlap: %s\n", error.message().c_str());
    std::exit(3);
}
void must(const Status& status) {
    if (!status) {
        stop(status.error());
    }
}

/// Milliseconds of every frame of a run.
struct Run {
    std::vector<double> simulation, logic, rest, queue;  ///< queue: the frame's passes on the renderer's queue, in rest
    double total = 0.0;
};

struct Rig {
    const cli::RenderInputs& inputs;
    cli::RenderSession& session;
    std::int64_t frames;
};

double passesOf(host::FluidHost& fluid) {
    const auto stats = fluid.stats(fluid.frame());
    double ms = 0.0;
    for (std::uint32_t i = 0; stats && i < stats.value().pass_count; ++i) {
        ms += static_cast<double>(stats.value().passes[i].nanoseconds) * 1e-6;
    }
    return ms;
}

/// `in_flight` 0: nothing runs beside anything.
Run runFrames(Rig& rig, std::uint32_t in_flight) {
    host::FluidHost& fluid = *rig.session.fluid;
    SluiceSimulation simulation = rig.inputs.live->view();
    simulation.frames_in_flight = std::max(in_flight, 1U);
    must(fluid.setSimulation(&simulation));
    Run run;
    std::int64_t asked = 0;
    const auto begin = Clock::now();
    for (std::int64_t k = 1; k <= rig.frames; ++k) {
        const auto ask = Clock::now();
        for (; asked < std::min(rig.frames, k + std::max<std::int64_t>(in_flight, 1) - 1); ++asked) {
            must(fluid.simulate(static_cast<std::uint64_t>(asked + 1), asked == 0 ? 0.0 : rig.inputs.live->frame_s));
        }
        if (in_flight == 0) {
            must(fluid.waitForSimulation(static_cast<std::uint64_t>(k), kLong));
        }
        run.simulation.push_back(since(ask));
        const auto think = Clock::now();
        rig.session.engine.animate(1.0F / 30.0F);
        run.logic.push_back(since(think));
        const auto draw = Clock::now();
        const SluiceCamera camera = scene::cameraAt(rig.inputs.scene, k, rig.inputs.size);
        rig.session.screen.bind();
        rig.session.engine.draw(camera, rig.inputs.scene.sky);
        host::FrameInput input;
        input.camera = camera;
        input.sky = rig.inputs.scene.sky;
        input.fluid = rig.inputs.scene.fluid;
        input.simulation = static_cast<std::uint64_t>(k);
        must(fluid.submit(rig.session.screen, input));
        must(fluid.composite(rig.session.screen));
        glFinish();  // what a swap of buffers would wait for
        run.rest.push_back(since(draw));
        run.queue.push_back(passesOf(fluid));
    }
    run.total = since(begin);
    return run;
}

double sum(const std::vector<double>& values) {
    double all = 0.0;
    for (const double value : values) {
        all += value;
    }
    return all;
}

/// The least that the same work can take. With one frame in flight frame k's picture waits for simulation and host's
/// work of k; with more, only what runs on one thread or on one queue has to take turns.
double idealOf(const Run& serial, std::uint32_t in_flight, bool own_queue) {
    if (in_flight == 1) {
        double all = sum(serial.rest);
        for (std::size_t k = 0; k < serial.logic.size(); ++k) {
            all += std::max(serial.simulation[k], serial.logic[k]);
        }
        return all;
    }
    return std::max(sum(serial.simulation) + (own_queue ? 0.0 : sum(serial.queue)),
                    sum(serial.logic) + sum(serial.rest));
}

/// The run of the middle, by its total.
Run middle(std::vector<Run> runs) {
    std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.total < b.total; });
    return runs[runs.size() / 2];
}

/// A banner whose step takes as long as `wanted` milliseconds.
void loadEngine(Rig& rig, host::EngineScene scene, double wanted) {
    host::Banner banner{{-1.2F, 2.4F, 1.2F}, {1.2F, 2.4F, 1.2F}, 1.6F, 64, 8};
    const auto with = [&](std::uint32_t iterations) {
        scene.banners.clear();
        banner.iterations = iterations;
        scene.banners.push_back(banner);
        Result<host::LegacyEngine> made = host::LegacyEngine::create(scene);
        if (!made) {
            stop(made.error());
        }
        rig.session.engine = std::move(made).value();
    };
    with(8);
    rig.session.engine.animate(1.0F / 30.0F);
    const auto begin = Clock::now();
    constexpr int kTimes = 10;
    for (int i = 0; i < kTimes; ++i) {
        rig.session.engine.animate(1.0F / 30.0F);
    }
    const double each = since(begin) / kTimes / 8.0;
    with(static_cast<std::uint32_t>(std::clamp(wanted / each, 1.0, 1000.0)));
}

void print(const Rig& rig, const std::array<std::vector<Run>, 4>& runs) {
    const Run serial = middle(runs[0]);
    const bool own = rig.session.fluid->simulationStats().value().own_queue != 0;
    const auto frames = static_cast<double>(rig.frames);
    const char* threads = std::getenv("LP_NUM_THREADS");
    fmt::print(
        "LP_NUM_THREADS {}, {}, {} timeline, simulation on {}, {} particles, {}x{}, {} frames, median of {} "
        "rounds. One after the other, of a frame: simulation {:.1f} ms, host's animation {:.1f} ms, draw to "
        "picture {:.1f} ms, of which the renderer's passes {:.1f} ms.\n\n",
        threads != nullptr ? threads : "not set", rig.session.fluid->info().capabilities.device_name,
        toString(static_cast<SluiceTimelineKind>(rig.session.fluid->info().timeline)),
        own ? "a queue of its own" : "the queue of the frames", rig.inputs.live->count(), rig.inputs.size.width,
        rig.inputs.size.height, rig.frames, runs[0].size(), sum(serial.simulation) / frames, sum(serial.logic) / frames,
        sum(serial.rest) / frames, sum(serial.queue) / frames);
    fmt::print(
        "| frames in flight | latency, frames | serial, ms a frame | overlapped | ideal | gain | efficiency |\n"
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    for (std::uint32_t in_flight = 1; in_flight <= SLUICE_MAX_FRAMES_IN_FLIGHT; ++in_flight) {
        const double overlapped = middle(runs.at(in_flight)).total;
        const double ideal = idealOf(serial, in_flight, own);
        fmt::print("| {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.2f} | {:.2f} |\n", in_flight, in_flight - 1,
                   serial.total / frames, overlapped / frames, ideal / frames, serial.total / overlapped,
                   ideal / overlapped);
    }
    fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
    cli::startLog(0, true);
    cli::RenderOptions options;
    options.scene = argc > 1 ? argv[1] : "samples/dam_break.json";
    const std::int64_t frames = argc > 2 ? std::atoll(argv[2]) : 16;
    const int rounds = argc > 3 ? std::atoi(argv[3]) : 3;
    const double load = argc > 4 ? std::atof(argv[4]) : 1.0;
    const float radius = argc > 5 ? static_cast<float>(std::atof(argv[5])) : 0.02F;
    options.frames = scene::FrameRange{1, std::max<std::int64_t>(frames, 2)};
    options.size = scene::Size{320, 180};
    Result<cli::RenderInputs> inputs = cli::readScene(options);
    if (!inputs) {
        stop(inputs.error());
    }
    if (!inputs.value().live) {
        stop({SLUICE_ERROR_INVALID_ARGUMENT, options.scene, "names particles: nothing is simulated", ""});
    }
    if (radius > 0.0F) {
        inputs.value().scene.simulation.radius = radius;
        Result<cli::LiveFluid> coarser = cli::liveFluid(inputs.value().scene, {}, {1, 1, inputs.value().frames.last});
        if (!coarser) {
            stop(coarser.error());
        }
        inputs.value().live.emplace(std::move(coarser).value());
    }
    Result<cli::RenderSession> session = cli::createSession(inputs.value());
    if (!session) {
        stop(session.error());
    }
    must(cli::startFluid(session.value(), inputs.value(), options));
    Rig rig{inputs.value(), session.value(), options.frames->last};
    // What the simulation takes here decides what the host shall have to do; this run also warms everything up.
    const Run first = runFrames(rig, 0);
    loadEngine(rig, inputs.value().scene.engine,
               load * sum(first.simulation) / static_cast<double>(first.simulation.size()));
    std::array<std::vector<Run>, 4> runs;
    for (int round = 0; round < std::max(rounds, 1); ++round) {
        for (std::uint32_t mode = 0; mode < runs.size(); ++mode) {
            runs.at(mode).push_back(runFrames(rig, mode));
        }
    }
    print(rig, runs);
    return 0;
}
