// SPDX-License-Identifier: MIT
// What a solver holds, and how it takes one step. For solver.cpp and solver_step.cpp alone.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "simulation/buffers.hpp"
#include "simulation/kernels.hpp"
#include "simulation/single_pass.hpp"
#include "simulation/solver.hpp"
#include "simulation/step_timer.hpp"

namespace sluice::vk {

/// Particles that one workgroup of most passes has.
inline constexpr std::uint32_t kGroup = 64;
[[nodiscard]] inline std::uint32_t groupsOf(std::uint32_t items, std::uint32_t group) {
    return (items + group - 1) / group;
}

/// Rows of the lists for that many neighbours. A quarter of room, so that they do not grow at every step of a fluid
/// that is being pressed together.
[[nodiscard]] inline std::uint32_t roomFor(std::uint32_t most_neighbours) {
    return (most_neighbours + most_neighbours / 4 + 15) / 16 * 16;
}

/// Particles in the order of the lists, and behind them those that have none.
struct Surroundings {
    VkBuffer position = VK_NULL_HANDLE, identity = VK_NULL_HANDLE;
    std::uint32_t entries = 0;  ///< of which some may be gone
    std::uint32_t moved = 0;    ///< of those, the ones that have lists
};

struct Solver::State {
    State(const Device& on, SimulationSettings with)
        : device(on), settings(std::move(with)), opened(!settings.sources.emitters.empty()), timer(on) {}

    const Device& device;
    SimulationSettings settings;
    bool opened;  ///< there were emitters at the start: somebody may come, even if all are shut now
    Grid grid;
    Kernels kernels;
    SimulationBuffers buffers;
    Buffer meshes;                      ///< DistanceGrid as solids.glsl reads it
    Buffer seen;                        ///< DepthField as seen.glsl reads it; unused while another one is
    VkBuffer seen_by = VK_NULL_HANDLE;  ///< that of the next step
    StepTimer timer;
    SinglePass anisotropy, whitewater;  ///< built at their first use
    std::vector<Solid> walls;           ///< faces of the domain and solids, for bodies
    std::vector<BodyState> bodies;      ///< at the start of the next step
    std::vector<BodyState> moving;      ///< at the end of the step under way
    SourceBlock sources{};              ///< with the outlets of the step under way
    StepCounts counts;                  ///< of the next step
    std::uint32_t moved = 0;            ///< particles that the last kept step had
    std::uint32_t planned = 0;          ///< particles that the grid was made for
    double time = 0.0;                  ///< s, since the particles were given
    bool odd = false;                   ///< In and Out have changed places
    bool measurable = false;            ///< the sorted buffers are those of the state
    bool searched = false;              ///< they are those of a search, which has moved nothing
    double speed = 0.0;                 ///< m/s, of the fastest particle
    double depth = 0.0;                 ///< m, of the last step; 0: not known yet, or not held to
    StepWatch watch;                    ///< of advance(); may be empty

    /// A drain may have taken all, and an emitter not have given any yet.
    [[nodiscard]] bool ready() const { return counts.living > 0 || (changing() && planned > 0); }
    [[nodiscard]] bool changing() const { return opened || !settings.sources.drains.empty(); }
    void restartBodies() {
        bodies.clear();
        for (Body& body : settings.bodies) {
            body.drive = {};  // where it was sent, and when, is of another time
            bodies.push_back(startOf(body));
        }
    }
    void run(VkCommandBuffer commands, Kernel kernel, std::uint32_t groups);
    /// From the clearing of the counters to the lists.
    void recordSearch(VkCommandBuffer commands);
    void record(VkCommandBuffer commands);
    /// What the host looks at.
    void recordReadBack(VkCommandBuffer commands);
    /// Lists of the state where there are none of a step.
    [[nodiscard]] Status search();
    /// After a step or a search.
    [[nodiscard]] Surroundings surroundings() const;
    /// What a pass reads of that buffer as texels.
    [[nodiscard]] VkBufferView texels(Slot slot) const {
        return buffers.texels.at(static_cast<std::size_t>(slot)).handle;
    }
    /// Runs commands of compute passes behind all that has been written, times them, and waits for them.
    [[nodiscard]] Status runTimed(const std::function<void(VkCommandBuffer)>& record);
    [[nodiscard]] Result<StepStatus> tryStep(float dt);
    /// Buffers and a grid for so many. On an error everything is as before.
    [[nodiscard]] Status makeRoom(std::uint32_t particles, bool keep_state);
    /// Decides who is born at the end of a step of that length.
    [[nodiscard]] Status prepareBirths(double seconds);
    /// A step that is not kept yet; lists that were too short are made longer.
    [[nodiscard]] Result<StepReport> attempt(double seconds);
    void keep(const StepReport& report);
};

}  // namespace sluice::vk
