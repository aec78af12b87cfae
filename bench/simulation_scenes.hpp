// SPDX-License-Identifier: MIT
// What the measurements of the fluid solver share: two scenes that keep their shape at any number of particles, and the
// quantities that they are judged by.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include "device/device.hpp"
#include "simulation/solver.hpp"

namespace sluice::bench {

struct Scene {
    vk::SimulationSettings settings;
    std::vector<std::uint32_t> fluids{};  ///< of each particle; may be empty
    std::vector<float> positions;
    double base = 0.0;  ///< metres, of the water at first; it is twice as high

    [[nodiscard]] double spacing() const { return 2.0 * double{settings.radius}; }
};
/// Water `across` particles wide, twice as high and `deep` deep, in the corner of a trough 0.4 m wide at the water and
/// `reach` times as long.
[[nodiscard]] Scene waterInTrough(long across, long deep, double reach);
/// A column of about so many particles that falls into a trough four times as long, a quarter of its height deep.
[[nodiscard]] Scene damBreak(long particles);
/// The same water in a box of its own base: nothing but its weight acts on it.
[[nodiscard]] Scene standingColumn(long particles);

/// How much denser than at rest: max(density - 1, 0), of all particles.
struct Compression {
    double mean = 0.0, greatest = 0.0;
};
[[nodiscard]] Compression compressionOf(const std::vector<float>& densities);
/// Potential and kinetic, J per kg.
[[nodiscard]] double energyOf(const vk::ParticleState& state);
[[nodiscard]] double rmsSpeed(const vk::ParticleState& state);

/// Seconds on all threads of this process, and on the wall.
[[nodiscard]] double cpuSeconds();
[[nodiscard]] double wallSeconds();
/// Bytes of this process in its address space and in memory, and its open files.
[[nodiscard]] long virtualBytes();
[[nodiscard]] long residentBytes();
[[nodiscard]] long openFiles();

/// A measurement has nobody to hand an error to: it says why and ends.
template <typename T>
T take(Result<T> result) {
    if (!result) {
        fmt::print(stderr, "{}\n", result.error().message());
        std::exit(1);
    }
    return std::move(result).value();
}
inline void check(const Status& status) {
    if (!status) {
        fmt::print(stderr, "{}\n", status.error().message());
        std::exit(1);
    }
}

/// Takes the name of a kernel, poly6, spline or wendland, out of the arguments; without one it is the default.
[[nodiscard]] vk::DensityKernel takeKernel(int& argc, char** argv);
[[nodiscard]] std::unique_ptr<vk::Device> makeDevice();
[[nodiscard]] std::unique_ptr<vk::Solver> makeSolver(const vk::Device& device, const Scene& scene);

}  // namespace sluice::bench
