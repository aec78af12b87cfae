// SPDX-License-Identifier: MIT
// Where a simulation's bodies are in a frame: FRAME.bodies.json beside the frame's particles.
#pragma once

#include <filesystem>
#include <vector>

#include "simulator/simulator.hpp"
#include "sluice/host_gl/engine.hpp"
#include "sluice/result.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// dam_0001.pos has dam_0001.bodies.json.
[[nodiscard]] std::filesystem::path bodiesPath(const std::filesystem::path& particles);

/// `bodies` in the order of the setup, whole or not at all.
[[nodiscard]] Status writeBodies(const std::filesystem::path& particles, const simulator::Setup& setup,
                                 const std::vector<simulator::BodyPose>& poses);

/// The bodies beside a particle file, in world space; none, and no file is read, if the scene simulates none.
[[nodiscard]] Result<std::vector<host::MovingBody>> readBodies(const scene::Scene& scene,
                                                               const std::filesystem::path& particles);

}  // namespace sluice::cli
