// SPDX-License-Identifier: MIT
// Speed against error: what it costs to simulate a second of a dam break and of a standing column, and how far each is
// compressed, over iterations and longest step; as CSV for scripts/plot-simulation.
//   simulation_error PARTICLES [ITERATIONS,...] [HERTZ,...] [REPEATS] [dam|column] [poly6|spline|wendland]
// Error: max(density - 1, 0); its mean over particles and over samples every 0.05 s, and the greatest of all samples.
// Cost: least of the repeats of each 0.05 s, which are the same work bit for bit, summed; densities are read untimed.
// A run for which the solver found no stable step has no figures.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "simulation_scenes.hpp"

namespace {
using namespace sluice::bench;

struct Cost {
    double cpu = 0.0, wall = 0.0;  ///< seconds
};
struct Outcome {
    std::uint32_t particles = 0, steps = 0;
    Compression error;
    double energy = 0.0;  ///< greatest of all samples, of the first
    Cost cost;
    double seconds = 0.0;   ///< simulated
    bool unstable = false;  ///< the solver said that it found no step
};

constexpr double kSample = 0.05;  // s

Outcome measure(const sluice::vk::Device& device, const Scene& scene, int samples, double longest, long repeats) {
    Outcome outcome;
    std::vector<Cost> least(static_cast<std::size_t>(samples), Cost{1e9, 1e9});
    for (long repeat = 0; repeat < repeats; ++repeat) {
        const auto solver = makeSolver(device, scene);
        const double at_first = energyOf(take(solver->read()));
        outcome.particles = solver->count();
        outcome.steps = 0;
        outcome.error = {};
        for (Cost& part : least) {
            const double cpu = cpuSeconds();
            const double wall = wallSeconds();
            const auto report = solver->advance(kSample, longest);
            if (!report) {
                fmt::print(stderr, "{}\n", report.error().message());
                outcome.unstable = true;
                return outcome;
            }
            outcome.steps += report.value().steps;
            part.cpu = std::min(part.cpu, cpuSeconds() - cpu);
            part.wall = std::min(part.wall, wallSeconds() - wall);
            const Compression now = compressionOf(take(solver->densities()));
            outcome.error.mean += now.mean / samples;
            outcome.energy = std::max(outcome.energy, energyOf(take(solver->read())) / at_first);
            outcome.error.greatest = std::max(outcome.error.greatest, now.greatest);
        }
    }
    for (const Cost& part : least) {
        outcome.cost.cpu += part.cpu;
        outcome.cost.wall += part.wall;
    }
    outcome.seconds = samples * kSample;
    return outcome;
}

std::vector<std::uint32_t> listOf(const char* text) {
    std::vector<std::uint32_t> numbers;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, ',');) {
        numbers.push_back(static_cast<std::uint32_t>(std::clamp(std::strtol(part.c_str(), nullptr, 10), 1L, 10'000L)));
    }
    return numbers;
}

}  // namespace

int main(int argc, char** argv) {
    const auto kernel = takeKernel(argc, argv);
    if (argc < 2 || std::strtol(argv[1], nullptr, 10) < 1) {
        fmt::print(
            stderr,
            "simulation_error PARTICLES [ITERATIONS,...] [HERTZ,...] [REPEATS] [dam|column] [poly6|spline|wendland]\n");
        return 2;
    }
    const long particles = std::strtol(argv[1], nullptr, 10);
    const auto iterations = listOf(argc > 2 ? argv[2] : "1,2,4,8,16");
    const auto hertz = listOf(argc > 3 ? argv[3] : "60,120,250,500");
    const long repeats = argc > 4 ? std::max(1L, std::strtol(argv[4], nullptr, 10)) : 2;
    const std::string only = argc > 5 ? argv[5] : "";
    const auto device = makeDevice();
    fmt::print(
        "scene,particles,iterations,hertz,steps_per_s,mean_compression,greatest_compression,energy,cpu_ms_per_s,"
        "wall_ms_per_s\n");
    for (const bool falling : {true, false}) {
        if (!only.empty() && falling != (only == "dam")) {
            continue;
        }
        for (const std::uint32_t count : iterations) {
            for (const std::uint32_t rate : hertz) {
                Scene scene = falling ? damBreak(particles) : standingColumn(particles);
                scene.settings.iterations = count;
                scene.settings.kernel = kernel;
                const Outcome found = measure(*device, scene, falling ? 12 : 10, 1.0 / rate, repeats);
                if (found.unstable) {
                    fmt::print("{},{},{},{},,,,,,\n", falling ? "dam" : "column", found.particles, count, rate);
                    std::fflush(stdout);
                    continue;
                }
                fmt::print("{},{},{},{},{:.0f},{:.5f},{:.4f},{:.4f},{:.0f},{:.0f}\n", falling ? "dam" : "column",
                           found.particles, count, rate, found.steps / found.seconds, found.error.mean,
                           found.error.greatest, found.energy, 1e3 * found.cost.cpu / found.seconds,
                           1e3 * found.cost.wall / found.seconds);
                std::fflush(stdout);
            }
        }
    }
    return 0;
}
