// SPDX-License-Identifier: MIT
// What `sluice simulate` says at its end.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace sluice::cli {

struct SimulationSummary {
    std::string scene, device;
    std::int64_t first = 0, last = 0;  ///< frames
    std::uint64_t particles = 0, particles_at_end = 0;
    std::uint64_t born = 0, blocked = 0, drained = 0;
    float radius = 0.0F;
    double simulated_s = 0.0;  ///< time of the fluid
    double solver_s = 0.0;     ///< time that the steps took
    std::uint64_t steps = 0, split = 0;
    double shortest_step = 0.0;  ///< seconds
    double speed = 0.0;          ///< m/s
    std::uint32_t most_neighbours = 0;
    double mean_compression = 0.0;  ///< mean over frames, in densities of rest
    double greatest_density = 0.0;
    std::vector<std::pair<std::string, double>> passes;  ///< milliseconds in all
    std::vector<std::string> files, problems;
    std::uint32_t validation_messages = 0;
    std::uint64_t replay_hash = 0;
    int exit_code = 0;
};

[[nodiscard]] std::string simulationText(const SimulationSummary& summary);
[[nodiscard]] nlohmann::ordered_json simulationJson(const SimulationSummary& summary);

}  // namespace sluice::cli
