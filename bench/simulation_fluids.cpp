// SPDX-License-Identifier: MIT
// Two fluids in a box of 8 x LAYERS x 8 places of 0.04 m, the lower half one and the upper the other: what the ratio of
// their densities does to steps, over iterations.
//   simulation_fluids [SECONDS] [LAYERS]     of each case, 2 and 20 unless told
// `rest`: the light one above, from rest. `turn`: the heavy one above, each particle off its place by a tenth of a
// radius. Energy is kinetic and potential over that of the start, and must not grow.
#include <algorithm>
#include <cmath>
#include <random>

#include "simulation_scenes.hpp"

namespace {
using namespace sluice::bench;

constexpr int kWide = 8;
constexpr double kSpacing = 0.04;

struct Case {
    float ratio = 1.0F;
    bool turn = false;  ///< the heavy one is above
    int high = 20;      ///< layers
    std::uint32_t iterations = 4;
};

Scene boxOfTwo(const Case& what) {
    Scene scene;
    scene.base = kWide * kSpacing;
    scene.settings.radius = static_cast<float>(kSpacing / 2.0);
    scene.settings.iterations = what.iterations;
    scene.settings.low = {0, 0, 0};
    scene.settings.high = {static_cast<float>(scene.base), static_cast<float>(1.5 * kSpacing * what.high),
                           static_cast<float>(scene.base)};
    scene.settings.fluids = {{1.0F}, {1.0F / what.ratio}};
    std::mt19937 dice(1);
    for (int i = 0; i < kWide * what.high * kWide; ++i) {
        for (const int cell : {i % kWide, i / kWide % what.high, i / kWide / what.high}) {
            const double off = what.turn ? 0.1 * (static_cast<double>(dice() >> 8) * 0x1p-23 - 1.0) : 0.0;
            scene.positions.push_back(static_cast<float>(kSpacing * (cell + 0.5 + 0.5 * off)));
        }
        scene.fluids.push_back((i / kWide % what.high < what.high / 2) == what.turn ? 1U : 0U);
    }
    return scene;
}

struct Sums {
    double energy = 0.0, speed = 0.0, light = 0.0, heavy = 0.0, top = 0.0;
};

Sums sumsOf(const sluice::vk::ParticleState& state, float ratio) {
    Sums sums;
    std::vector<double> heights;
    const auto count = static_cast<double>(state.fluid.size());
    for (std::size_t i = 0; i < state.fluid.size(); ++i) {
        const double mass = state.fluid[i] == 0 ? 1.0 : 1.0 / double{ratio};
        const double square = std::pow(double{state.velocity[3 * i]}, 2) +
                              std::pow(double{state.velocity[3 * i + 1]}, 2) +
                              std::pow(double{state.velocity[3 * i + 2]}, 2);
        const auto height = double{state.position[3 * i + 1]};
        sums.energy += mass * (9.81 * height + 0.5 * square);
        sums.speed += square / count;
        (state.fluid[i] == 0 ? sums.heavy : sums.light) += 2.0 * height / count;
        heights.push_back(height);
    }
    sums.speed = std::sqrt(sums.speed);
    std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(heights.size() * 99 / 100),
                     heights.end());
    sums.top = heights[heights.size() * 99 / 100];
    return sums;
}

void runCase(const sluice::vk::Device& device, const Case& what, double seconds) {
    const Scene scene = boxOfTwo(what);
    const auto solver = makeSolver(device, scene);
    const double first = sumsOf(take(solver->read()), what.ratio).energy;
    double highest = 0.0;
    std::uint32_t steps = 0;
    for (int tenth = 0; tenth < std::lround(10.0 * seconds); ++tenth) {
        const auto report = solver->advance(0.1, 1.0 / 60.0);
        if (!report.ok()) {
            fmt::print("| {} | {} | {} | no stable step | | | | | |\n", what.ratio, what.turn ? "turn" : "rest",
                       what.iterations);
            std::fflush(stdout);
            return;
        }
        steps += report.value().steps;
        highest = std::max(highest, sumsOf(take(solver->read()), what.ratio).energy / first);
    }
    const Sums sums = sumsOf(take(solver->read()), what.ratio);
    const Compression found = compressionOf(take(solver->densities()));
    fmt::print("| {} | {} | {} | {} | {:.3f} | {:.3f} | {:.2f} %, {:.3f} | {:.3f}, {:.3f} | {:.3f} |\n", what.ratio,
               what.turn ? "turn" : "rest", what.iterations, steps, highest, sums.speed, 100.0 * found.mean,
               1.0 + found.greatest, sums.light, sums.heavy, sums.top);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    const double seconds = argc > 1 ? std::strtod(argv[1], nullptr) : 2.0;
    const int high = argc > 2 ? std::atoi(argv[2]) : 20;
    const auto device = makeDevice();
    fmt::print(
        "| ratio | case | iterations | steps | greatest energy, of the first | RMS speed, m/s | mean compression, "
        "greatest "
        "density | mean height of light, heavy, m | top, m |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- "
        "|\n");
    for (const bool turn : {false, true}) {
        for (const float ratio : {1.0F, 1.25F, 2.0F, 4.0F, 8.0F, 16.0F}) {
            runCase(*device, {ratio, turn, std::clamp(high, 4, 200)}, seconds);
        }
    }
    return 0;
}
