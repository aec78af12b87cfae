// SPDX-License-Identifier: MIT
// OBJ files as solids of a simulation.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "simulator/simulator.hpp"
#include "sluice/result.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// Pure. Corners and faces of an OBJ, as they are in the file; convex faces of more than three corners are cut into
/// triangles. An error names what is no corner or no face. `name` is used in messages.
[[nodiscard]] Result<simulator::Mesh> parseObj(const std::string& text, const std::string& name);

/// Reads the simulation's meshes and puts them where the scene says. Corners are floats, as the renderer gets them.
[[nodiscard]] Result<std::vector<simulator::Mesh>> readMeshes(const scene::Simulation& simulation);

/// For the engine, which draws them.
[[nodiscard]] std::vector<host::TriangleMesh> drawnMeshes(const std::vector<simulator::Mesh>& meshes);

}  // namespace sluice::cli
