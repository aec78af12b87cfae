// SPDX-License-Identifier: MIT
// The dam break in which other solvers are compared with this one: 21 x 42 x 21 particles of 0.05 m in a trough four
// times as long, as .pos files every 0.05 s for particle_density, and what they cost.
//   peer_dam ITERATIONS LONGEST SECONDS [FOLDER] [poly6|spline|wendland]       LONGEST in s, 0.005 for example
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "simulation_scenes.hpp"

namespace {

void writePos(const std::string& name, float radius, const std::vector<float>& positions) {
    const auto count = static_cast<std::uint32_t>(positions.size() / 3);
    std::ofstream file(name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(&count), sizeof count);
    file.write(reinterpret_cast<const char*>(&radius), sizeof radius);
    file.write(reinterpret_cast<const char*>(positions.data()), static_cast<std::streamsize>(4 * positions.size()));
    if (!file.flush()) {
        fmt::print(stderr, "{}: cannot be written\n", name);
        std::exit(1);
    }
}

}  // namespace

int main(int argc, char** argv) {
    using namespace sluice::bench;
    const auto kernel = takeKernel(argc, argv);
    if (argc < 4) {
        fmt::print(stderr, "peer_dam ITERATIONS LONGEST SECONDS [FOLDER] [poly6|spline|wendland]\n");
        return 2;
    }
    constexpr int kWide = 21;
    constexpr int kHigh = 42;
    constexpr double kSpacing = 0.05;
    const double longest = std::strtod(argv[2], nullptr);
    Scene scene;
    scene.base = kWide * kSpacing;
    scene.settings.radius = static_cast<float>(kSpacing / 2.0);
    scene.settings.iterations = static_cast<std::uint32_t>(std::strtoul(argv[1], nullptr, 10));
    scene.settings.kernel = kernel;
    scene.settings.low = {0, 0, 0};
    scene.settings.high = {static_cast<float>(4.0 * scene.base), static_cast<float>(3.0 * scene.base),
                           static_cast<float>(scene.base)};
    for (int i = 0; i < kWide * kHigh * kWide; ++i) {
        for (const int cell : {i % kWide, i / kWide % kHigh, i / kWide / kHigh}) {
            scene.positions.push_back(static_cast<float>(kSpacing * (cell + 0.5)));
        }
    }
    const auto device = makeDevice();
    const auto solver = makeSolver(*device, scene);
    const int frames = static_cast<int>(std::lround(std::strtod(argv[3], nullptr) / 0.05));
    double cpu = 0.0;
    double wall = 0.0;
    std::uint32_t steps = 0;
    Compression own;
    for (int frame = 1; frame <= frames; ++frame) {
        const double cpu_begin = cpuSeconds();
        const double wall_begin = wallSeconds();
        steps += take(solver->advance(0.05, longest)).steps;
        cpu += cpuSeconds() - cpu_begin;
        wall += wallSeconds() - wall_begin;
        const Compression now = compressionOf(take(solver->densities()));
        own.mean += now.mean / frames;
        own.greatest = std::max(own.greatest, now.greatest);
        if (argc > 4) {
            std::filesystem::create_directories(argv[4]);
            writePos(fmt::format("{}/{:04}.pos", argv[4], frame), scene.settings.radius, take(solver->read()).position);
        }
    }
    const double seconds = frames * 0.05;
    fmt::print(
        "{} particles, {} iterations, step <= {} s: {} steps, own mean {:.3f} %, greatest {:.1f} %, {:.0f} ms CPU "
        "and {:.0f} ms wall per simulated second, {:.2f} ms wall per step\n",
        solver->count(), scene.settings.iterations, longest, steps, 100.0 * own.mean, 100.0 * own.greatest,
        1e3 * cpu / seconds, 1e3 * wall / seconds, 1e3 * wall / steps);
    return 0;
}
