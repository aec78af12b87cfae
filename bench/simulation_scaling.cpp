// SPDX-License-Identifier: MIT
// Cost and memory of a particle over the number of particles: the first steps of a dam break, as a Markdown table.
//   simulation_scaling [PARTICLES...]
// Times are the least of eight steps of 2 ms. Memory is what the process grew by from before the solver to after them,
// which on a software device is the device's memory: its address space, and what of it was ever touched.
#include <algorithm>
#include <cmath>

#include "simulation_scenes.hpp"

int main(int argc, char** argv) {
    using namespace sluice::bench;
    std::vector<long> counts;
    for (int i = 1; i < argc; ++i) {
        counts.push_back(std::clamp(std::strtol(argv[i], nullptr, 10), 100L, 10'000'000L));
    }
    if (counts.empty()) {
        counts = {10'000, 30'000, 100'000, 300'000, 1'000'000};
    }
    fmt::print(
        "| particles | CPU ms per step | wall ms per step | CPU ns per particle and step | of the first | bytes per "
        "particle | of which touched | neighbours at most |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    const auto device = makeDevice();
    double first = 0.0;
    for (const long count : counts) {
        const Scene scene = damBreak(count);
        const auto virtual_before = static_cast<double>(virtualBytes());
        const auto resident_before = static_cast<double>(residentBytes());
        const auto solver = makeSolver(*device, scene);
        double cpu = 1e9;
        double wall = 1e9;
        std::uint32_t neighbours = 0;
        for (int step = 0; step < 8; ++step) {
            const double cpu_begin = cpuSeconds();
            const double wall_begin = wallSeconds();
            neighbours = std::max(neighbours, take(solver->step(0.002)).most_neighbours);
            cpu = std::min(cpu, cpuSeconds() - cpu_begin);
            wall = std::min(wall, wallSeconds() - wall_begin);
        }
        const double particles = solver->count();
        const double each = 1e9 * cpu / particles;
        first = first > 0.0 ? first : each;
        fmt::print("| {} | {:.1f} | {:.1f} | {:.0f} | {:.2f} | {:.0f} | {:.0f} | {} |\n", solver->count(), 1e3 * cpu,
                   1e3 * wall, each, each / first, (static_cast<double>(virtualBytes()) - virtual_before) / particles,
                   (static_cast<double>(residentBytes()) - resident_before) / particles, neighbours);
        std::fflush(stdout);
    }
    return 0;
}
