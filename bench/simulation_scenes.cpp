// SPDX-License-Identifier: MIT
#include "simulation_scenes.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

namespace sluice::bench {
namespace {

constexpr double kBase = 0.4;  // m
constexpr double kGravity = 9.81;

double squares(const std::vector<float>& values) {
    double total = 0.0;
    for (const float value : values) {
        total += double{value} * double{value};
    }
    return total;
}

/// The field of /proc/self/statm, in bytes.
long memoryOfProcess(int field) {
    std::ifstream file("/proc/self/statm");
    long pages = 0;
    for (int i = 0; i <= field; ++i) {
        file >> pages;
    }
    return pages * sysconf(_SC_PAGESIZE);
}

}  // namespace

Scene waterInTrough(long across, long deep, double reach) {
    Scene scene;
    scene.base = kBase;
    const double spacing = kBase / static_cast<double>(across);
    scene.settings.radius = static_cast<float>(spacing / 2.0);
    scene.settings.overshoot = 0.0F;  // what is measured here is what the rule is for
    scene.settings.low = {0, 0, 0};
    scene.settings.high = {static_cast<float>(reach * kBase), static_cast<float>(3.0 * kBase),
                           static_cast<float>(static_cast<double>(deep) * spacing)};
    for (long z = 0; z < deep; ++z) {
        for (long y = 0; y < 2 * across; ++y) {
            for (long x = 0; x < across; ++x) {
                for (const long cell : {x, y, z}) {
                    scene.positions.push_back(static_cast<float>(spacing * (static_cast<double>(cell) + 0.5)));
                }
            }
        }
    }
    return scene;
}

Scene damBreak(long particles) {
    const long across = std::max(4L, std::lround(std::cbrt(static_cast<double>(particles))));
    return waterInTrough(across, (across + 1) / 2, 4.0);
}

Scene standingColumn(long particles) {
    const long across = std::max(4L, std::lround(std::cbrt(static_cast<double>(particles))));
    return waterInTrough(across, (across + 1) / 2, 1.0);
}

Compression compressionOf(const std::vector<float>& densities) {
    Compression all;
    for (const float density : densities) {
        const double over = std::max(0.0, double{density} - 1.0);
        all.mean += over;
        all.greatest = std::max(all.greatest, over);
    }
    all.mean /= static_cast<double>(std::max<std::size_t>(1, densities.size()));
    return all;
}

double energyOf(const vk::ParticleState& state) {
    double potential = 0.0;
    for (std::size_t i = 1; i < state.position.size(); i += 3) {
        potential += kGravity * double{state.position[i]};
    }
    return (potential + 0.5 * squares(state.velocity)) * 3.0 / static_cast<double>(state.position.size());
}

double rmsSpeed(const vk::ParticleState& state) {
    return std::sqrt(squares(state.velocity) * 3.0 / static_cast<double>(state.velocity.size()));
}

double cpuSeconds() {
    std::timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double wallSeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

long virtualBytes() {
    return memoryOfProcess(0);
}

long residentBytes() {
    return memoryOfProcess(1);
}

long openFiles() {
    const auto entries = std::filesystem::directory_iterator("/proc/self/fd");
    return static_cast<long>(std::distance(begin(entries), end(entries)));
}

vk::DensityKernel takeKernel(int& argc, char** argv) {
    constexpr std::array<std::pair<std::string_view, vk::DensityKernel>, 3> kNames{
        {{"poly6", vk::DensityKernel::Poly6},
         {"spline", vk::DensityKernel::Spline},
         {"wendland", vk::DensityKernel::Wendland}}};
    vk::DensityKernel kernel = vk::SimulationSettings().kernel;
    char** const end = std::remove_if(argv + 1, argv + argc, [&](const char* argument) {
        const auto* const named =
            std::find_if(kNames.begin(), kNames.end(), [&](const auto& name) { return name.first == argument; });
        kernel = named != kNames.end() ? named->second : kernel;
        return named != kNames.end();
    });
    argc = static_cast<int>(end - argv);
    return kernel;
}

std::unique_ptr<vk::Device> makeDevice() {
    vk::DeviceRequest request;
    request.match_host = false;
    return take(vk::Device::create(request));
}

std::unique_ptr<vk::Solver> makeSolver(const vk::Device& device, const Scene& scene) {
    auto solver = take(vk::Solver::create(device, scene.settings));
    check(solver->setParticles(scene.positions, {}, scene.fluids));
    return solver;
}

}  // namespace sluice::bench
