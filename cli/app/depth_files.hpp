// SPDX-License-Identifier: MIT
// Pictures' depths as what a simulation's fluid collides with. They are of the scene's own camera.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "simulator/simulator.hpp"
#include "sluice/result.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// Whether each frame has a file of its own; else there is one, of frame 1.
[[nodiscard]] bool depthMoves(const scene::Simulation& simulation);

/// The files of frames 1 to `last` - 1, and that of frame 1 at least; none where the fluid meets no depth.
[[nodiscard]] Result<std::vector<std::filesystem::path>> depthFiles(const scene::Simulation& simulation,
                                                                    std::int64_t last);

/// That they are there, have depths and are of the scene's camera; then that of frame 1.
[[nodiscard]] Result<std::shared_ptr<const vk::DepthField>> firstDepth(const scene::Scene& scene, std::int64_t last);

/// What the picture of `frame` shows, for particles of the simulation's radius.
[[nodiscard]] Result<std::shared_ptr<const vk::DepthField>> loadDepth(const scene::Scene& scene, std::int64_t frame);

}  // namespace sluice::cli
