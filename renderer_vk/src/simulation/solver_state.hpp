// SPDX-License-Identifier: MIT
// What a solver holds, and how it takes one step. For solver.cpp and solver_step.cpp alone.
#pragma once

#include <utility>

#include "simulation/buffers.hpp"
#include "simulation/kernels.hpp"
#include "simulation/solver.hpp"
#include "simulation/step_timer.hpp"

namespace sluice::vk {

/// Particles that one workgroup of most passes has.
inline constexpr std::uint32_t kGroup = 64;
[[nodiscard]] inline std::uint32_t groupsOf(std::uint32_t items, std::uint32_t group) {
    return (items + group - 1) / group;
}

struct Solver::State {
    State(const Device& on, SimulationSettings with) : device(on), settings(std::move(with)), timer(on) {}

    const Device& device;
    SimulationSettings settings;
    Grid grid;
    Kernels kernels;
    SimulationBuffers buffers;
    StepTimer timer;
    std::uint32_t count = 0;
    bool odd = false;         ///< In and Out have changed places
    bool measurable = false;  ///< the sorted buffers are those of the state
    double speed = 0.0;       ///< m/s, of the fastest particle

    void run(VkCommandBuffer commands, Kernel kernel, std::uint32_t groups);
    void record(VkCommandBuffer commands);
    [[nodiscard]] Result<StepStatus> tryStep(float dt);
    [[nodiscard]] Status makeRoom(std::uint32_t particles);
    /// A step that is not kept yet; lists that were too short are made longer.
    [[nodiscard]] Result<StepReport> attempt(double seconds);
    void keep(const StepReport& report);
};

}  // namespace sluice::vk
