// SPDX-License-Identifier: MIT
// A scene's simulation as the renderer takes it: fluid that flows while the frames are drawn.
#pragma once

#include <cstdint>
#include <vector>

#include "simulator/simulator.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// Value k of the simulation is frame k, and frame 1 the start, as `sluice simulate` has it; to the bit, too.
struct LiveFluid {
    std::vector<SluiceSolid> solids;
    simulator::Particles start;
    SluiceSimulation settings{};  ///< without its arrays
    double frame_s = 0.0;

    /// The ABI's view, which must not outlive this.
    [[nodiscard]] SluiceSimulation view() const;
    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(start.position.size() / 3); }
};

/// Whether the scene says that its fluid is to be simulated: it names no particles, and has fluid.
[[nodiscard]] bool simulatesLive(const scene::Scene& scene);

/// Emitters, drains, fields, moving bodies and surface tension are refused: they do not cross the C ABI.
[[nodiscard]] Result<LiveFluid> liveFluid(const scene::Scene& scene, std::uint64_t seed,
                                          std::uint32_t frames_in_flight);

}  // namespace sluice::cli
