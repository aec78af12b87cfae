// SPDX-License-Identifier: MIT
// A small dam break that is left alone for very many steps: its particles, its energy and the process's memory and open
// files at ten checkpoints.
//   simulation_long [STEPS] [PARTICLES]
#include <algorithm>
#include <cmath>

#include "simulation_scenes.hpp"

int main(int argc, char** argv) {
    using namespace sluice::bench;
    const auto number = [&](int index, long otherwise) {
        return argc > index ? std::max(10L, std::strtol(argv[index], nullptr, 10)) : otherwise;
    };
    const long wanted = number(1, 10'000);
    const auto device = makeDevice();
    const Scene scene = damBreak(number(2, 4096));
    const auto solver = makeSolver(*device, scene);
    fmt::print(
        "step,seconds,particles,not_finite,outside,energy_J_per_kg,rms_speed,mean_compression,resident_KiB,files\n");
    long taken = 0;
    double seconds = 0.0;
    for (int checkpoint = 0; checkpoint <= 10; ++checkpoint) {
        while (taken < wanted * checkpoint / 10) {
            constexpr double kFrame = 1.0 / 120.0;
            taken += take(solver->advance(kFrame, kFrame)).steps;
            seconds += kFrame;
        }
        const auto state = take(solver->read());
        long broken = 0;
        long outside = 0;
        for (std::size_t i = 0; i < state.position.size(); ++i) {
            broken += std::isfinite(state.position[i]) && std::isfinite(state.velocity[i]) ? 0 : 1;
            outside += state.position[i] < scene.settings.low[i % 3] || state.position[i] > scene.settings.high[i % 3];
        }
        const double mean = taken == 0 ? 0.0 : compressionOf(take(solver->densities())).mean;
        fmt::print("{},{:.3f},{},{},{},{:.5f},{:.5f},{:.5f},{},{}\n", taken, seconds, state.position.size() / 3, broken,
                   outside, energyOf(state), rmsSpeed(state), mean, residentBytes() / 1024, openFiles());
        std::fflush(stdout);
        if (broken + outside > 0 || state.position.size() != scene.positions.size()) {
            fmt::print(stderr, "particles were lost or broken\n");
            return 1;
        }
    }
    return 0;
}
