// SPDX-License-Identifier: MIT
// Milliseconds per step of the fluid solver, pass by pass: a block of water that falls apart in a box.
//   simulation_cost [PARTICLES] [STEPS] [ITERATIONS]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "device/device.hpp"
#include "simulation/solver.hpp"

int main(int argc, char** argv) {
    using namespace sluice::vk;
    const auto number = [&](int index, long otherwise) {
        return argc > index ? std::max(1L, std::strtol(argv[index], nullptr, 10)) : otherwise;
    };
    const long side = std::lround(std::cbrt(static_cast<double>(number(1, 20'000)) / 2.0));
    const long steps = number(2, 100);
    SimulationSettings settings;
    settings.radius = 0.01F;
    settings.iterations = static_cast<std::uint32_t>(number(3, 4));
    const float edge = 0.02F * static_cast<float>(side);
    settings.low = {0, 0, 0};
    settings.high = {3.0F * edge, 3.0F * edge, edge};
    std::vector<float> positions;
    for (long y = 0; y < 2 * side; ++y) {
        for (long z = 0; z < side; ++z) {
            for (long x = 0; x < side; ++x) {
                for (const long cell : {x, y, z}) {
                    positions.push_back(0.02F * (static_cast<float>(cell) + 0.5F));
                }
            }
        }
    }
    DeviceRequest request;
    request.match_host = false;
    auto device = Device::create(request);
    if (!device) {
        fmt::print(stderr, "{}\n", device.error().message());
        return 1;
    }
    auto solver = Solver::create(*device.value(), settings);
    if (!solver) {
        fmt::print(stderr, "{}\n", solver.error().message());
        return 1;
    }
    if (const auto status = solver.value()->setParticles(positions, {}); !status) {
        fmt::print(stderr, "{}\n", status.error().message());
        return 1;
    }
    std::vector<double> times;
    std::uint32_t neighbours = 0;
    double speed = 0.0;
    for (long i = 0; i < steps; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        const auto report = solver.value()->step(0.002);
        if (!report) {
            fmt::print(stderr, "{}\n", report.error().message());
            return 1;
        }
        times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
        neighbours = std::max(neighbours, report.value().most_neighbours);
        speed = report.value().speed;
    }
    std::sort(times.begin(), times.end());
    fmt::print("{} particles, {} steps of 2 ms, {} iterations: median {:.2f} ms, least {:.2f}, most {:.2f}\n",
               solver.value()->count(), steps, settings.iterations, times[times.size() / 2], times.front(),
               times.back());
    const auto densities = solver.value()->densities();
    if (densities) {
        double sum = 0.0;
        double most = 0.0;
        for (const float density : densities.value()) {
            sum += std::max(0.0, double{density} - 1.0);
            most = std::max(most, double{density});
        }
        fmt::print("most neighbours {}, speed {:.3f} m/s, mean compression {:.4f}, greatest density {:.3f}\n",
                   neighbours, speed, sum / static_cast<double>(densities.value().size()), most);
    }
    for (const auto& [name, ms] : solver.value()->times()) {
        fmt::print("  {:12} {:8.3f} ms per step\n", name, ms / static_cast<double>(steps));
    }
    return 0;
}
