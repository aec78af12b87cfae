// SPDX-License-Identifier: MIT
// A column of water at rest, 8 x 20 x 8 particles of 0.04 m, two seconds: how far its weight compresses it, over
// iterations and longest step, and its density with height at the solver's defaults.
//   simulation_column [TENSILE] [poly6|spline|wendland]      the artificial pressure, that of the defaults unless told
#include <algorithm>
#include <cmath>

#include "simulation_scenes.hpp"

namespace {
using namespace sluice::bench;

constexpr int kWide = 8;
constexpr int kHigh = 20;
constexpr double kSpacing = 0.04;

Scene column(std::uint32_t iterations) {
    Scene scene;
    scene.base = kWide * kSpacing;
    scene.settings.radius = static_cast<float>(kSpacing / 2.0);
    scene.settings.iterations = iterations;
    scene.settings.overshoot = 0.0F;  // what is measured here is what the rule is for
    scene.settings.low = {0, 0, 0};
    scene.settings.high = {static_cast<float>(scene.base), 1.2F, static_cast<float>(scene.base)};
    for (int i = 0; i < kWide * kHigh * kWide; ++i) {
        for (const int cell : {i % kWide, i / kWide % kHigh, i / kWide / kHigh}) {
            scene.positions.push_back(static_cast<float>(kSpacing * (cell + 0.5)));
        }
    }
    return scene;
}

/// Mean and greatest density of the particles in each layer as high as a particle at rest.
void printProfile(const std::vector<float>& position, const std::vector<float>& density) {
    struct Layer {
        int count = 0;
        double sum = 0.0, most = 0.0;
    };
    std::vector<Layer> layers(kHigh + 2);
    for (std::size_t i = 0; i < density.size(); ++i) {
        const auto at = static_cast<std::size_t>(double{position[3 * i + 1]} / kSpacing);
        Layer& layer = layers[std::min(at, layers.size() - 1)];
        ++layer.count;
        layer.sum += double{density[i]};
        layer.most = std::max(layer.most, double{density[i]});
    }
    fmt::print("\n| height, m | particles | mean density | greatest |\n| --- | --- | --- | --- |\n");
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (layers[i].count > 0) {
            fmt::print("| {:.2f} to {:.2f} | {} | {:.4f} | {:.3f} |\n", static_cast<double>(i) * kSpacing,
                       static_cast<double>(i + 1) * kSpacing, layers[i].count, layers[i].sum / layers[i].count,
                       layers[i].most);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto kernel = takeKernel(argc, argv);
    const float tensile = argc > 1 ? std::strtof(argv[1], nullptr) : sluice::vk::SimulationSettings().tensile;
    const auto device = makeDevice();
    fmt::print(
        "| iterations, longest step | mean compression | greatest density | RMS speed, m/s | "
        "greatest energy, of the first | height kept |\n| --- | --- | --- | --- | --- | --- |\n");
    std::vector<float> position;
    std::vector<float> density;
    for (const std::uint32_t iterations : {1U, 2U, 4U, 8U, 16U}) {
        for (const int hertz : {60, 120, 250, 500}) {
            Scene scene = column(iterations);
            scene.settings.tensile = tensile;
            scene.settings.kernel = kernel;
            const auto solver = makeSolver(*device, scene);
            const auto middle = [](const sluice::vk::ParticleState& state) {
                double sum = 0.0;
                for (std::size_t i = 1; i < state.position.size(); i += 3) {
                    sum += double{state.position[i]};
                }
                return sum;
            };
            const auto before = take(solver->read());
            double highest = 0.0;
            bool stable = true;
            for (int tenth = 0; tenth < 20 && stable; ++tenth) {
                stable = solver->advance(0.1, 1.0 / hertz).ok();
                highest = std::max(highest, energyOf(take(solver->read())));
            }
            if (!stable) {
                fmt::print("| {}, 1/{} s | no stable step | | | | |\n", iterations, hertz);
                continue;
            }
            const auto state = take(solver->read());
            const auto densities = take(solver->densities());
            const Compression found = compressionOf(densities);
            fmt::print("| {}, 1/{} s | {:.2f} % | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n", iterations, hertz,
                       100.0 * found.mean, 1.0 + found.greatest, rmsSpeed(state), highest / energyOf(before),
                       middle(state) / middle(before));
            std::fflush(stdout);
            if (iterations == sluice::vk::SimulationSettings().iterations && hertz == 120) {
                position = state.position;
                density = densities;
            }
        }
    }
    printProfile(position, density);
    return 0;
}
