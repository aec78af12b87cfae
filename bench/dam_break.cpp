// SPDX-License-Identifier: MIT
// The dam break of Martin & Moyce 1952 (n^2 = 2), as curves: front and height at the wall over dimensionless time, as
// CSV. scripts/plot-simulation draws them against what others measured and computed (bench/data/dam_break.csv).
//   dam_break [ACROSS...] [poly6|spline|wendland]    particles across the column, 20 unless told
#include <algorithm>
#include <cmath>
#include <vector>

#include "simulation_scenes.hpp"

int main(int argc, char** argv) {
    using namespace sluice::bench;
    const auto kernel = takeKernel(argc, argv);
    std::vector<long> resolutions;
    for (int i = 1; i < argc; ++i) {
        resolutions.push_back(std::clamp(std::strtol(argv[i], nullptr, 10), 4L, 200L));
    }
    if (resolutions.empty()) {
        resolutions = {20};
    }
    const auto device = makeDevice();
    fmt::print("across,particles,time,front,height\n");
    for (const long across : resolutions) {
        // 6 deep at 20, as in the test that holds it to a bound.
        Scene scene = waterInTrough(across, across * 3 / 10, 6.0);
        scene.settings.kernel = kernel;
        const auto solver = makeSolver(*device, scene);
        const double unit = std::sqrt(scene.base / (2.0 * 9.81));  // seconds
        const auto radius = double{scene.settings.radius};
        constexpr double kStep = 0.05;  // of dimensionless time
        for (int sample = 0; sample * kStep <= 3.4; ++sample) {
            if (sample > 0) {
                take(solver->advance(kStep * unit, 1.0 / 120.0));
            }
            const std::vector<float> x = take(solver->read()).position;
            double front = 0.0;
            double height = 0.0;
            for (std::size_t i = 0; i < x.size(); i += 3) {
                front = std::max(front, double{x[i]});
                height = double{x[i]} < 1.5 * scene.spacing() ? std::max(height, double{x[i + 1]}) : height;
            }
            fmt::print("{},{},{:.2f},{:.4f},{:.4f}\n", across, solver->count(), sample * kStep,
                       (front + radius) / scene.base, (height + radius) / (2.0 * scene.base));
        }
    }
    return 0;
}
