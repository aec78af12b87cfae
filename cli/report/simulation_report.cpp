// SPDX-License-Identifier: MIT
#include "report/simulation_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/table.hpp"

namespace sluice::cli {
namespace {

double perStep(double milliseconds, const SimulationSummary& s) {
    return s.steps + s.split == 0 ? 0.0 : milliseconds / static_cast<double>(s.steps + s.split);
}

std::string hashText(std::uint64_t hash) {
    return fmt::format("{:016x}", hash);
}

}  // namespace

std::string simulationText(const SimulationSummary& s) {
    std::string text =
        fmt::format("{} particles of radius {:.5f} m on {}\n", formatCount(s.particles), s.radius, s.device);
    if (s.steps > 0) {
        std::vector<std::vector<std::string>> rows{{"pass", "ms per step"}};
        for (const auto& [name, milliseconds] : s.passes) {
            rows.push_back({name, fmt::format("{:.3f}", perStep(milliseconds, s))});
        }
        rows.push_back({"all, with the host", fmt::format("{:.3f}", perStep(1e3 * s.solver_s, s))});
        text += formatTable(rows, {1});
        text += fmt::format("{:.3f} s of fluid in {} steps, the shortest {:.2f} ms; {} taken again in halves\n",
                            s.simulated_s, formatCount(s.steps), 1e3 * s.shortest_step, formatCount(s.split));
        text += fmt::format(
            "compression {:.2f} % in the mean, greatest density {:.3f}; fastest {:.2f} m/s; up to {} neighbours\n",
            100.0 * s.mean_compression, s.greatest_density, s.speed, s.most_neighbours);
    }
    if (s.born + s.blocked + s.drained > 0) {
        text +=
            fmt::format("{} born, {} blocked by what was in the way, {} drained: {} at the end\n", formatCount(s.born),
                        formatCount(s.blocked), formatCount(s.drained), formatCount(s.particles_at_end));
    }
    text += fmt::format("{} {}, frames {} to {}; replay hash {}\n", formatCount(s.files.size()),
                        s.files.size() == 1 ? "file" : "files", s.first, s.last, hashText(s.replay_hash));
    return text;
}

nlohmann::ordered_json simulationJson(const SimulationSummary& s) {
    nlohmann::ordered_json passes = nlohmann::ordered_json::array();
    for (const auto& [name, milliseconds] : s.passes) {
        passes.push_back({{"name", name}, {"ms_per_step", perStep(milliseconds, s)}});
    }
    return {{"scene", s.scene},
            {"device", s.device},
            {"frames", {{"first", s.first}, {"last", s.last}, {"written", s.files.size()}}},
            {"particles",
             {{"count", s.particles},
              {"radius", s.radius},
              {"at_end", s.particles_at_end},
              {"born", s.born},
              {"blocked", s.blocked},
              {"drained", s.drained}}},
            {"simulated_s", s.simulated_s},
            {"solver_s", s.solver_s},
            {"steps", s.steps},
            {"steps_taken_again", s.split},
            {"shortest_step_s", s.shortest_step},
            {"fastest", s.speed},
            {"most_neighbours", s.most_neighbours},
            {"mean_compression", s.mean_compression},
            {"greatest_density", s.greatest_density},
            {"passes", passes},
            {"replay_hash", hashText(s.replay_hash)},
            {"validation_messages", s.validation_messages},
            {"files", s.files},
            {"problems", s.problems},
            {"exit_code", s.exit_code}};
}

}  // namespace sluice::cli
