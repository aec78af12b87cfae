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
    std::vector<SluiceEmitter> emitters;
    std::vector<SluiceDrain> drains;
    std::vector<SluiceForceField> fields;
    std::vector<SluiceBody> bodies;
    std::vector<SluicePathPoint> path_points;
    std::vector<SluiceMesh> meshes;
    std::vector<SluiceFluidKind> fluids;
    std::vector<float> mesh_corners;
    std::vector<std::uint32_t> mesh_indices;
    simulator::Particles start;
    SluiceSimulation settings{};  ///< without its arrays
    double frame_s = 0.0;

    /// The ABI's view, which must not outlive this.
    [[nodiscard]] SluiceSimulation view() const;
    /// At the start; settings.max_particles is the most.
    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(start.position.size() / 3); }
};

/// Whether the scene says that its fluid is to be simulated: it names no particles, and has fluid.
[[nodiscard]] bool simulatesLive(const scene::Scene& scene);

struct LiveRequest {
    std::uint64_t seed = 0;
    std::uint32_t frames_in_flight = 1;
    std::int64_t last_frame = 1;
};
/// `meshes`: those of the scene, as readMeshes has them.
[[nodiscard]] Result<LiveFluid> liveFluid(const scene::Scene& scene, const std::vector<simulator::Mesh>& meshes,
                                          const LiveRequest& request);

}  // namespace sluice::cli
