// SPDX-License-Identifier: MIT
// OBJ files as solids of a simulation.
#pragma once

#include <filesystem>
#include <string>

#include "simulator/simulator.hpp"
#include "sluice/result.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// Pure. Corners and faces of an OBJ, as they are in the file; convex faces of more than three corners are cut into
/// triangles. An error names what is no corner or no face. `name` is used in messages.
[[nodiscard]] Result<simulator::Mesh> parseObj(const std::string& text, const std::string& name);

/// Reads the simulation's meshes, puts them where the scene says, and makes them solids of the setup.
[[nodiscard]] Status loadMeshes(simulator::Setup& setup, const scene::Simulation& simulation);

}  // namespace sluice::cli
